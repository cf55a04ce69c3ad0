// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/common/pose.hpp"

namespace tumble {

/// What became of a sweep. Anything but `registered` means that the pose rests on the inertial prior.
enum class SweepVerdict : std::uint8_t {
  first,       ///< started the map
  registered,  ///< aligned with the map in all six directions
  degenerate,  ///< aligned where the surfaces allow it, prior elsewhere (everywhere, when conditioning is 0)
  rejected,    ///< too few matches, or a correction beyond the bound: prior kept; the map grows where it had too few
};
const char* to_string(SweepVerdict verdict);

/// What the mapper made of a sweep.
struct SweepReport {
  SweepVerdict verdict = SweepVerdict::rejected;
  PoseState pose;                     ///< pose and velocity of the IMU at the end of the sweep, with covariance
  std::vector<PoseState> trajectory;  ///< IMU poses inside the sweep at IMU times, corrected by the registration
  /// The same of the sweep that stands at the old end of the window with this one as its newest: its last word, by
  /// this sweep and those between. With a window of two that is the sweep before. Empty while the window fills.
  std::vector<PoseState> smoothed;
  double inlier_share = 0.0;  ///< of the points registered
  double conditioning = 0.0;  ///< smallest over largest eigenvalue of the scaled normal matrix
  /// Standard deviation in the direction that the surfaces hold least, by this sweep's surfaces alone; 0: not
  /// aligned.
  double weakest_sigma_m = 0.0;
  /// Length of the correction of pose and velocity in standard deviations of the inertial prior's error, per root of
  /// its nine unknowns: 1 at most, in the mean, where prior and surfaces are what they claim to be; 0: not aligned.
  double innovation = 0.0;
  int iterations = 0;
  int lost_sweeps = 0;  ///< rejected in a row up to this sweep, this one included
  /// Found again after lost sweeps, where inertia had not expected it, and not borne out by two further sweeps yet: one
  /// that contradicts it takes the place back.
  bool unconfirmed = false;
  /// Direction in which the surfaces hold the pose least: (position, attitude scaled by the rms lever) in W, unit.
  Eigen::Matrix<double, 6, 1> weakest_direction = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Vector3d saturation_deficit_rad_s =
      Eigen::Vector3d::Zero();        ///< added to the clipped axes, along the sign of the rate; mean of the knots
  std::size_t points_used = 0;        ///< finite returns in range that are not the robot's own
  std::size_t points_alone = 0;       ///< of these, that nothing beside them bears out, and that are not used further
  std::size_t points_registered = 0;  ///< one per voxel of the rest
  std::size_t map_points_added = 0;
};

}  // namespace tumble
