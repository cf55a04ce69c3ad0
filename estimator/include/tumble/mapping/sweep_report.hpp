// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/common/pose.hpp"

namespace tumble {

/// Source of a sweep's pose: registration or inertial prediction. A `degenerate` sweep with eigenvalue_ratio 0 uses the
/// prediction in every direction.
enum class SweepVerdict : std::uint8_t {
  first,       ///< the sweep started the map
  registered,  ///< aligned with the map in all six directions
  degenerate,  ///< aligned where surfaces constrain the pose, predicted elsewhere
  rejected,    ///< too few matches or too large a correction: pose is predicted
};
const char* to_string(SweepVerdict verdict);

struct SweepReport {
  SweepVerdict verdict = SweepVerdict::rejected;
  PoseState pose;  ///< pose and velocity of the IMU at the end of the sweep, with covariance
  /// covariance of the velocity in IMU axes at the end of the sweep [m^2/s^2]
  Eigen::Matrix3d velocity_covariance_I_m2_s2 = Eigen::Matrix3d::Zero();
  std::vector<PoseState> trajectory;  ///< IMU poses within the sweep, corrected by the registration
  /// Final poses of the oldest sweep that the fixed-lag smoother refines; empty until `window_sweeps` sweeps have
  /// arrived. With the default `window_sweeps` of 2, the oldest sweep is the previous sweep.
  std::vector<PoseState> smoothed;
  double inlier_ratio = 0.0;      ///< fraction of the registered points that are inliers
  double eigenvalue_ratio = 0.0;  ///< smallest divided by largest eigenvalue of the scaled normal matrix
  /// standard deviation of the pose in the least constrained direction, from this sweep's points alone; 0: not aligned
  double least_constrained_sigma_m = 0.0;
  /// Normalised innovation sqrt(d' P^-1 d / 9). The nine components of d are the corrections of the predicted position,
  /// attitude and velocity, and P is the covariance of the inertial prediction. The mean innovation is at most 1 if the
  /// covariances are correct; 0 means that the sweep was not aligned.
  double innovation = 0.0;
  /// Standard deviation of the position relative to the map around the robot. The covariance of `pose` also includes
  /// the map's drift and tilt, which grow with the travelled distance.
  double map_sigma_m = 0.0;
  int iterations = 0;
  int consecutive_rejected_sweeps = 0;  ///< consecutive rejected sweeps, including the current sweep
  /// True if the sweep relocalised the robot at an unpredicted pose, and two further sweeps have not yet confirmed this
  /// pose. A contradicting sweep reverts the relocalisation.
  bool relocalisation_unconfirmed = false;
  /// Unit vector of position and attitude in world axes, along which the lidar constrains the pose least. To have the
  /// same unit as position, attitude is multiplied by the root-mean-square distance of the points from the IMU.
  Eigen::Matrix<double, 6, 1> least_constrained_direction = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Vector3d mean_saturation_deficit_rad_s =
      Eigen::Vector3d::Zero();        ///< mean correction of the clipped gyro axes
  std::size_t points_used = 0;        ///< finite returns in range that do not hit the robot
  std::size_t isolated_points = 0;    ///< unused returns that no neighbouring beam confirms
  std::size_t points_registered = 0;  ///< usable points after sampling, one per voxel
  std::size_t map_points_added = 0;
  /// true if the poses are in the frame of the prior map
  bool in_prior_map = false;
};

}  // namespace tumble
