// SPDX-License-Identifier: BSD-3-Clause
#include "world_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

using Pose = WorldCovariance::Pose;

// The errors of successive sweeps are correlated, so the position error grows in proportion to the distance from the
// start (0.24 % in a hall with pillars).
constexpr double kScale = 0.003;
// The map drifts in the direction that surfaces constrain least. The standard deviation of the drift per sweep is
// kDriftRatio times the standard deviation of the pose in the least constrained direction.
constexpr double kDriftRatio = 0.1, kDriftSigmaMax_m = 3.0;

/// See mapping.md (R57).
Pose subtract_mounting(const Registration::Matrix& joint, const Pose& by_mounting) {
  Eigen::Matrix<double, 6, Registration::kUnknowns> G = Eigen::Matrix<double, 6, Registration::kUnknowns>::Zero();
  unknowns::columns(G, unknowns::pose).setIdentity();
  unknowns::columns(G, unknowns::mounting) = -by_mounting;
  const Pose P = G * joint * G.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

/// See mapping.md (R56).
Pose WorldCovariance::mounting_jacobian_at_start(const Eigen::Vector3d& p_WI_m) const {
  Pose start = mounting_jacobian_at_start_;
  start.topRows<3>() -= so3::hat(p_WI_m - first_position_W_m_) * mounting_jacobian_at_start_.bottomRows<3>();
  return start;
}

WorldCovariance WorldCovariance::covariance_in_prior_map(const WorldCovarianceParams& params,
                                                         const Eigen::Vector3d& p_WI_m) {
  WorldCovariance out;
  out.params_ = params;
  out.params_.tilt_sigma_rad = 0.0;
  out.first_position_W_m_ = out.last_map_extension_W_m_ = p_WI_m;
  return out;
}

double WorldCovariance::sigma_in_map_m(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const {
  const Pose P = subtract_mounting(joint, mounting_jacobian_at_start(p_WI_m));
  return std::sqrt(std::max(P.topLeftCorner<3, 3>().trace(), 0.0));
}

/// See mapping.md (R58).
Pose WorldCovariance::in_world_frame(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const {
  const Eigen::Vector3d from_start_m = p_WI_m - first_position_W_m_;
  Eigen::Matrix<double, 6, 2> by_tilt = Eigen::Matrix<double, 6, 2>::Zero();
  by_tilt.topRows<3>() = -so3::hat(from_start_m).leftCols<2>();
  by_tilt.block<2, 2>(3, 0).setIdentity();
  Pose P = subtract_mounting(joint, mounting_jacobian_at_start(p_WI_m));
  P += map_ + (params_.tilt_sigma_rad * params_.tilt_sigma_rad) * by_tilt * by_tilt.transpose();
  P.topLeftCorner<3, 3>() += drift_covariance_m2_ + kScale * kScale * from_start_m * from_start_m.transpose();
  return P;
}

/// See mapping.md (R61).
void WorldCovariance::add_drift(double least_constrained_sigma_m,
                                const Eigen::Matrix<double, 6, 1>& least_constrained_direction) {
  const double sigma_m = kDriftRatio * std::min(least_constrained_sigma_m, kDriftSigmaMax_m);
  const Eigen::Vector3d direction = least_constrained_direction.head<3>();
  drift_covariance_m2_ += (sigma_m * sigma_m) * direction * direction.transpose();
}

/// See mapping.md (R59), (R60). Mounting errors of the lidar do not change the map.
void WorldCovariance::add_inserted_sweep(double inserted_fraction, const SweepTrajectory& trajectory,
                                         const Registration::Matrix& errors, const Eigen::Vector3d& p_IL_m) {
  const double middle_s = 0.5 * trajectory.duration_s();
  // A rotation error of the map causes a position error in proportion to the distance from the last sweep with points
  // inserted into the map.
  const Eigen::Vector3d p_WI_m = trajectory.state(middle_s).p_WI_m;
  Pose moved = Pose::Identity();
  moved.topRightCorner<3, 3>() = -so3::hat(p_WI_m - last_map_extension_W_m_);
  map_ = (moved * map_ * moved.transpose()).eval();
  last_map_extension_W_m_ = p_WI_m;
  const Registration::Matrix F = unknowns_at(trajectory, middle_s);
  map_ += inserted_fraction * inserted_fraction *
          subtract_mounting(propagate_pose_and_mounting(F, errors),
                            pose_mounting_jacobian(trajectory.state(middle_s).q_WI, p_IL_m));
}

}  // namespace tumble::mapping
