// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_estimate.hpp"

namespace tumble::mapping {

/// Errors of the map relative to the world: mounting, tilt of the start, scale, errors at insertion, and drift in
/// unconstrained directions. The IMU's first pose defines the world.
class WorldCovariance {
 public:
  using Pose = Eigen::Matrix<double, 6, 6>;

  WorldCovariance() = default;
  /// Starts at the first pose of the IMU.
  WorldCovariance(const WorldCovarianceParams& params, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m,
                  const Eigen::Vector3d& p_WI_m = Eigen::Vector3d::Zero())
      : params_(params),
        start_W_m_(p_WI_m),
        map_at_W_m_(p_WI_m),
        start_mounting_jacobian_(pose_mounting_jacobian(q_WI, p_IL_m)) {}

  /// Returns the errors relative to a prior map, in which a run continues at a position. The prior map is exact.
  static WorldCovariance of_prior_map(const WorldCovarianceParams& params, const Eigen::Vector3d& p_WI_m);

  /// Returns the covariance of a pose's error in the world. `joint` is the covariance of all unknowns in the map at the
  /// time of the pose.
  Pose in_world(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// Returns the standard deviation of a pose's position relative to the map around the pose [m].
  double sigma_in_map_m(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// Adds the drift of a moving sweep, with its weakest standard deviation and direction (position, scaled attitude).
  void add_drift(double least_constrained_sigma_m, const Eigen::Matrix<double, 6, 1>& least_constrained_direction);
  /// Adds the error of a sweep that inserted a fraction of the visible map, evaluated at the middle of the sweep's
  /// motion. `errors` is the covariance at the start of the sweep.
  void add_insertion(double inserted_fraction, const SweepTrajectory& trajectory, const Registration::Matrix& errors,
                     const Eigen::Vector3d& p_IL_m);

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  Pose start_mounting_jacobian(const Eigen::Vector3d& p_WI_m) const;

  WorldCovarianceParams params_;
  Eigen::Vector3d start_W_m_ = Eigen::Vector3d::Zero();   // position of the first pose
  Eigen::Vector3d map_at_W_m_ = Eigen::Vector3d::Zero();  // position of the sweep that extended the map last
  Pose start_mounting_jacobian_ = Pose::Zero();
  Pose map_ = Pose::Zero();                                        // of the map relative to the world, at map_at_W_m_
  Eigen::Matrix3d drift_covariance_m2_ = Eigen::Matrix3d::Zero();  // of the position
};

}  // namespace tumble::mapping
