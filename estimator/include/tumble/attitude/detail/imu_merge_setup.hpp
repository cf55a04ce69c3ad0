// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

/// Number, poses and ranges of the IMUs that ImuMerge fuses.
struct ImuMergeSetup {
  static constexpr int kImus = 4;
  /// pose of each IMU in the common axes C of the rigid body; the first `count` entries are used
  std::array<Eigen::Isometry3d, kImus> T_mean_imu{};
  int count = 1;
  /// An accelerometer reading above this fraction of the range may be saturated during a part of its averaging window.
  static constexpr double kSubsampleSaturationRatio = 0.15;
  static constexpr double kRateNoise_rad_s = 0.01;  ///< standard deviation of a gyro's mean rate over a window
  static constexpr double kWindow_s = 4e-3;
  static constexpr double kGapMax_s = 1.0;
  double gyro_range_rad_s = 1e3;  ///< readings at or above this rate are saturated
  double accel_range_m_s2 = 1e5;
  /// directions of the sensing elements of each IMU, as found by SaturationPlaneFinder
  std::array<SensingDirections, kImus> gyro_sensing_directions{}, accel_sensing_directions{};
};

}  // namespace tumble
