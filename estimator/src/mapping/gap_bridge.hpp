// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/mapping/detail/sweep_trajectory.hpp"

namespace tumble::mapping {

/// If two IMU samples are more than kGap_ns apart, the interval is a gap, because one reading does not describe the
/// motion over 50 ms.
inline constexpr TimeNs kGap_ns = 50'000'000;

struct WindowRate {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d sigma_rad_s;
  TimeNs from_ns, time_ns;

  TimeNs middle_ns() const { return from_ns + (time_ns - from_ns) / 2; }
};

/// Fills the gap from the end of `before` to the start of `after` with linearly interpolated angular rates: mapping.md
/// (R44). In a gap, all gyro axes count as clipped, so that the registration also estimates the interpolation error. In
/// a gap of up to 0.64 s, each appended sample covers 10 ms. In a longer gap, each appended sample covers about 1/64 of
/// the gap.
void bridge_gap(const WindowRate& before, const WindowRate& after, std::vector<MotionSample>& samples);

}  // namespace tumble::mapping
