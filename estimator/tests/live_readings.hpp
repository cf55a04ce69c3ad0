// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tumble/common/types.hpp"

namespace tumble::test {

/// Readings of a sensor that is alive: no two are the same to the last bit, but where its gyro stands at its rail.
inline std::vector<ImuSample> noisy(std::vector<ImuSample> imu,
                                    double rail_rad_s = std::numeric_limits<double>::infinity()) {
  std::uint32_t drawn = 1;
  const auto draw = [&] { return static_cast<double>((drawn = 1664525 * drawn + 1013904223) >> 8) / 16777216.0 - 0.5; };
  for (ImuSample& sample : imu) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(sample.angular_velocity_rad_s[axis]) < rail_rad_s)
        sample.angular_velocity_rad_s[axis] += 2e-3 * draw();
      sample.specific_force_m_s2[axis] += 2e-2 * draw();
    }
  }
  return imu;
}

}  // namespace tumble::test
