// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns true if the times of a lidar's points were measured; otherwise they are derived from the sweep.
inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
