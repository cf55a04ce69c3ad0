// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::bench {

/// Adds three people to the lidar returns of a recording: upright cylinders of 0.5 m by 1.75 m that walk at 1.2 m/s on
/// circles around the robot's start, on the ground level with it. A hit on a person replaces the return behind it, and
/// keeps the noise of the range. The truth is unchanged, because people are no surface of a map.
void let_people_walk(const sim::Truth& truth, sim::Sensors& sensors);

}  // namespace tumble::bench
