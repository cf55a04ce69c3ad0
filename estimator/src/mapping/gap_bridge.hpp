// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/mapping/detail/inertial_params.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"

namespace tumble::mapping {

/// A time between two IMU samples above kGap_ns is a gap, because the reading does not describe the motion in between.
inline constexpr TimeNs kGap_ns = 50'000'000;

/// WindowRate is the mean angular rate over the averaging window of one IMU sample, with its standard deviation.
struct WindowRate {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d sigma_rad_s;
  TimeNs from_ns, time_ns;

  TimeNs middle_ns() const { return from_ns + (time_ns - from_ns) / 2; }
};

/// Appends samples that fill the gap from the end of `before` to the start of `after`, see mapping.md (R44). The
/// angular rate is interpolated linearly, with the standard deviation of a random walk whose ends are known. All axes
/// of the appended samples count as clipped, so that a registration that estimates the saturation deficit also
/// estimates the interpolation error. The specific force of the appended samples is unknown (`bridges_gap`). Each
/// appended sample is 10 ms long, or longer in gaps beyond 0.64 s.
void bridge_gap(const InertialNoiseParams& params, const WindowRate& before, const WindowRate& after,
                std::vector<MotionSample>& samples);

}  // namespace tumble::mapping
