// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/common/pose.hpp"

namespace tumble {

/// Result category of a sweep. For every value except `registered`, the pose relies on the inertial prior.
enum class SweepVerdict : std::uint8_t {
  first,       ///< the sweep started the map
  registered,  ///< aligned with the map in all six directions
  degenerate,  ///< aligned where surfaces constrain it, prior elsewhere (everywhere if conditioning is 0)
  rejected,    ///< too few matches or correction out of bounds: prior kept; with too few matches, the map is extended
};
const char* to_string(SweepVerdict verdict);

/// Result of the mapper for one sweep.
struct SweepReport {
  SweepVerdict verdict = SweepVerdict::rejected;
  PoseState pose;                     ///< pose and velocity of the IMU at the end of the sweep, with covariance
  std::vector<PoseState> trajectory;  ///< IMU poses inside the sweep at IMU times, corrected by the registration
  /// Final poses of the oldest sweep in the window, smoothed with the newest sweep and the sweeps between. With a
  /// window of two, the oldest sweep is the previous sweep. The list is empty while the window fills.
  std::vector<PoseState> smoothed;
  double inlier_share = 0.0;  ///< fraction of the registered points
  double conditioning = 0.0;  ///< smallest over largest eigenvalue of the scaled normal matrix
  /// Standard deviation of the pose in the least constrained direction, from this sweep's surfaces alone. Zero means
  /// that the sweep was not aligned.
  double weakest_sigma_m = 0.0;
  /// Normalised innovation: length of the correction of pose and velocity in standard deviations of the inertial prior,
  /// divided by the root of its nine unknowns. The mean innovation is at most 1 if prior and surfaces have the stated
  /// accuracy. Zero means that the sweep was not aligned.
  double innovation = 0.0;
  /// Standard deviation of the position relative to the map around the robot. The covariance of `pose` also contains
  /// the map's drift and tilt, which grow with the path.
  double map_sigma_m = 0.0;
  int iterations = 0;
  int lost_sweeps = 0;  ///< consecutive rejected sweeps up to this one, inclusive
  /// True for a relocalisation after tracking failure that inertial prediction did not expect and that two further
  /// sweeps have not yet confirmed. A further sweep that contradicts the relocalisation reverts it.
  bool unconfirmed = false;
  /// Direction in W in which the surfaces constrain the pose least. The unit vector contains position and attitude
  /// scaled by the root-mean-square lever arm.
  Eigen::Matrix<double, 6, 1> weakest_direction = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Vector3d saturation_deficit_rad_s =
      Eigen::Vector3d::Zero();        ///< added to the clipped axes, along the sign of the rate; mean of the knots
  std::size_t points_used = 0;        ///< finite returns in range that do not hit the robot itself
  std::size_t lone_points = 0;        ///< lone returns among the finite returns, which no neighbouring beam confirms;
                                      ///< not used
  std::size_t points_registered = 0;  ///< one per voxel of the remaining points
  std::size_t map_points_added = 0;
};

}  // namespace tumble
