// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief.hpp"

namespace tumble::mapping {

/// What parts the map from the world, which is held by the IMU's first pose: the mounting, the tilt of the start, what
/// the map was inserted with, and what no surface held.
class WorldCovariance {
 public:
  using Pose = Eigen::Matrix<double, 6, 6>;

  WorldCovariance() = default;
  /// At the first pose of the IMU.
  WorldCovariance(const WorldCovarianceParams& params, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m)
      : params_(params), start_by_mounting_(pose_by_mounting(q_WI, p_IL_m)) {}

  /// Covariance of a pose's error in the world, of a joint covariance of all unknowns in the map at that instant.
  Pose in_world(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// A sweep in motion that its surfaces hold so little, in this direction (position, scaled attitude).
  void add_drift(double weakest_sigma_m, const Eigen::Matrix<double, 6, 1>& weakest_direction);
  /// A sweep inserted this share of what is seen from here, from the middle of its motion, and was off by `errors` at
  /// its start.
  void add_insertion(double inserted_share, const SweepTrajectory& trajectory, const Registration::Matrix& errors,
                     const Eigen::Vector3d& p_IL_m);

  /// Stated once: `mapping_members.hpp`.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  WorldCovarianceParams params_;
  Pose start_by_mounting_ = Pose::Zero();
  Pose map_ = Pose::Zero();                             // of the map against the world where the robot is
  Eigen::Matrix3d drift_m2_ = Eigen::Matrix3d::Zero();  // of the position
};

}  // namespace tumble::mapping
