// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns whether each point has its own measured time. If points have no measured times, their times are derived from
/// the sweep.
inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
