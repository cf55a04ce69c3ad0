// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Whether each point has a time of its own, and not one that follows from its sweep.
inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
