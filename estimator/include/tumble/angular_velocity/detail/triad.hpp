// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tumble/common/types.hpp"

namespace tumble {

enum class Triad : std::uint8_t { gyro, accelerometer };

/// unit: rad/s for the gyro, m/s^2 for the accelerometer
inline const Eigen::Vector3d& triad_reading_of(const ImuSample& sample, Triad triad) {
  return triad == Triad::gyro ? sample.angular_velocity_rad_s : sample.specific_force_m_s2;
}

}  // namespace tumble
