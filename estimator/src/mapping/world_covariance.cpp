// SPDX-License-Identifier: BSD-3-Clause
#include "world_covariance.hpp"

#include <algorithm>

#include "tumble/common/so3.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

using Pose = WorldCovariance::Pose;

/// Returns the covariance of the pose error minus the effect of the mounting error, `by_mounting`: mapping.md (R57).
Pose less_mounting(const Registration::Matrix& joint, const Pose& by_mounting) {
  Eigen::Matrix<double, 6, Registration::kUnknowns> G = Eigen::Matrix<double, 6, Registration::kUnknowns>::Zero();
  unknowns::columns(G, unknowns::pose).setIdentity();
  unknowns::columns(G, unknowns::mounting) = -by_mounting;
  const Pose P = G * joint * G.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

/// Adds the map error at the position of the pose, and the tilt error of the start: mapping.md (R58).
Pose WorldCovariance::in_world(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const {
  // a rotation of the map about its start moves distant points: mapping.md (R56)
  Pose start = start_by_mounting_;
  start.topRows<3>() -= so3::hat(p_WI_m) * start_by_mounting_.bottomRows<3>();
  Eigen::Matrix<double, 6, 2> by_tilt = Eigen::Matrix<double, 6, 2>::Zero();
  by_tilt.topRows<3>() = -so3::hat(p_WI_m).leftCols<2>();
  by_tilt.block<2, 2>(3, 0).setIdentity();
  Pose P = less_mounting(joint, start);
  P += map_ + (params_.tilt_sigma_rad * params_.tilt_sigma_rad) * by_tilt * by_tilt.transpose();
  P.topLeftCorner<3, 3>() += drift_m2_;
  return P;
}

/// Adds the drift of a sweep in the direction that the surfaces constrain least: mapping.md (R61).
void WorldCovariance::add_drift(double weakest_sigma_m, const Eigen::Matrix<double, 6, 1>& weakest_direction) {
  const double sigma_m = params_.drift_share * std::min(weakest_sigma_m, params_.drift_sigma_max_m);
  const Eigen::Vector3d direction = weakest_direction.head<3>();
  drift_m2_ += (sigma_m * sigma_m) * direction * direction.transpose();
}

/// Adds the error of a sweep to the map error, at the lidar's pose in the middle of the sweep: mapping.md (R59), (R60).
/// The pose is more uncertain at the start and end of a sweep than in its middle. An error of the mounting is not an
/// error of the map.
void WorldCovariance::add_insertion(double inserted_share, const SweepTrajectory& trajectory,
                                    const Registration::Matrix& errors, const Eigen::Vector3d& p_IL_m) {
  const double middle_s = 0.5 * trajectory.duration_s();
  const Registration::Matrix F = unknowns_at(trajectory, middle_s);
  map_ += inserted_share * inserted_share *
          less_mounting(pose_and_mounting(F, errors), pose_by_mounting(trajectory.state(middle_s).q_WI, p_IL_m));
}

}  // namespace tumble::mapping
