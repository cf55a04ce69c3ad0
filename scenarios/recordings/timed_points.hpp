// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns whether the points of a lidar have individually measured times. If point times are not measured, they are
/// derived from the sweep.
inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
