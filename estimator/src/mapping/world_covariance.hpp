// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_estimate.hpp"

namespace tumble::mapping {

/// WorldCovariance contains the errors of the map relative to the world: mounting, tilt of the start, errors at
/// insertion, and drift in unconstrained directions. The first pose of the IMU defines the world.
class WorldCovariance {
 public:
  using Pose = Eigen::Matrix<double, 6, 6>;

  WorldCovariance() = default;
  /// Starts at the first pose of the IMU.
  WorldCovariance(const WorldCovarianceParams& params, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m)
      : params_(params), start_by_mounting_(pose_by_mounting(q_WI, p_IL_m)) {}

  /// Returns the covariance of a pose's error in the world. `joint` is the covariance of all unknowns in the map at the
  /// time of the pose.
  Pose in_world(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// Adds the drift of a moving sweep, given the standard deviation and the direction (position, scaled attitude) that
  /// surfaces constrain least.
  void add_drift(double weakest_sigma_m, const Eigen::Matrix<double, 6, 1>& weakest_direction);
  /// Adds the error of a sweep that inserted a fraction of the visible map, evaluated at the middle of the sweep's
  /// motion. `errors` is the covariance at the start of the sweep.
  void add_insertion(double inserted_share, const SweepTrajectory& trajectory, const Registration::Matrix& errors,
                     const Eigen::Vector3d& p_IL_m);

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  WorldCovarianceParams params_;
  Pose start_by_mounting_ = Pose::Zero();
  Pose map_ = Pose::Zero();                             // covariance of the map relative to the world
  Eigen::Matrix3d drift_m2_ = Eigen::Matrix3d::Zero();  // covariance of the position drift
};

}  // namespace tumble::mapping
