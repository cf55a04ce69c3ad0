// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "tumble/common/imu.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Whether a lidar's metre is that of the IMU.
namespace tumble::scenarios {

/// By how much ways between sweeps are longer than the IMU has it.
struct SweepScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t changes = 0;  ///< of velocity that were compared

  /// Further from 1 than 2 % and than five of its deviations.
  bool is_off() const;
};

/// Scale of a run's sweeps. Over two spans of 0.4 s in a row the mean velocities of the sweeps' ends differ by what the
/// IMU has felt meanwhile, whatever velocity was before: gravity in flight, the ground's blows. The slope of the one
/// over the other, robustly (Huber, 1964), is 1; ranges that are 10 % too long make it 1.1, less what the mapper
/// believes the IMU. Attitudes are those of the run. Where the accelerometer was at its rail, or surfaces did not say
/// where a sweep was, nothing is compared; its deviation is that of residuals as they are spread (White, 1980).
/// `gravity_m_s2`: strength of gravity. Not seen: where the body is not accelerated, and an accelerometer of another
/// scale, which gravity at rest tells. O(N).
SweepScale find_sweep_scale(std::span<const ImuSample> samples,
                            std::span<const LidarInertialOdometry::SweepReport> sweeps, double gravity_m_s2);

}  // namespace tumble::scenarios
