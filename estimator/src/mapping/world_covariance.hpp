// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_estimate.hpp"

namespace tumble::mapping {

/// WorldCovariance is the covariance of the map relative to the world frame, which the first pose of the IMU defines.
/// The covariance of the map includes errors of mounting, initial tilt, scale and inserted sweeps, and drift in
/// unconstrained directions.
class WorldCovariance {
 public:
  using Pose = Eigen::Matrix<double, 6, 6>;

  WorldCovariance() = default;
  WorldCovariance(const WorldCovarianceParams& params, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m,
                  const Eigen::Vector3d& p_WI_m = Eigen::Vector3d::Zero())
      : params_(params),
        first_position_W_m_(p_WI_m),
        last_map_extension_W_m_(p_WI_m),
        mounting_jacobian_at_start_(pose_mounting_jacobian(q_WI, p_IL_m)) {}

  /// Returns the covariance after localisation in a prior map. The prior map is assumed exact.
  static WorldCovariance covariance_in_prior_map(const WorldCovarianceParams& params, const Eigen::Vector3d& p_WI_m);

  /// Returns the covariance of the IMU pose in the world frame, at the IMU position `p_WI_m`. `joint` is the covariance
  /// of the registration's unknowns relative to the map.
  Pose in_world_frame(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// Returns the standard deviation of the IMU's position relative to the nearby part of the map.
  double sigma_in_map_m(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// `least_constrained_direction` is the direction of motion (position, scaled attitude) that the surfaces around the
  /// sensor constrain least.
  void add_drift(double least_constrained_sigma_m, const Eigen::Matrix<double, 6, 1>& least_constrained_direction);
  /// `inserted_fraction` is the fraction of the sweep's points that were inserted into the map. `errors` is the
  /// covariance of the registration's unknowns at the start of the sweep.
  void add_inserted_sweep(double inserted_fraction, const SweepTrajectory& trajectory,
                          const Registration::Matrix& errors, const Eigen::Vector3d& p_IL_m);

  double tilt_sigma_rad() const { return params_.tilt_sigma_rad; }

 private:
  Pose mounting_jacobian_at_start(const Eigen::Vector3d& p_WI_m) const;

  WorldCovarianceParams params_;
  Eigen::Vector3d first_position_W_m_ = Eigen::Vector3d::Zero();  // position of the first pose of the IMU
  Eigen::Vector3d last_map_extension_W_m_ =
      Eigen::Vector3d::Zero();  // position of the sweep that extended the map last
  Pose mounting_jacobian_at_start_ = Pose::Zero();
  Pose map_ = Pose::Zero();  // covariance of the map relative to the world, at last_map_extension_W_m_
  Eigen::Matrix3d drift_covariance_m2_ = Eigen::Matrix3d::Zero();  // covariance of the position drift
};

}  // namespace tumble::mapping
