// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Triad names one of the two sensors of an IMU, gyro or accelerometer, each with three axes.
enum class Triad : std::uint8_t { gyro, accelerometer };

/// Returns the reading of the gyro [rad/s] or of the accelerometer [m/s^2].
inline const Eigen::Vector3d& reading_of(const ImuSample& sample, Triad triad) {
  return triad == Triad::gyro ? sample.angular_velocity_rad_s : sample.specific_force_m_s2;
}

}  // namespace tumble
