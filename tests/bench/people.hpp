// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::bench {

/// Adds three people to a recording's lidar returns: upright cylinders of 0.5 m by 1.75 m. The people walk at 1.2 m/s
/// on circles around the start of the robot, on level ground. If a ray meets a cylinder, its return moves there with
/// the same range noise. The truth is unchanged, because people are not a surface of the map.
void let_people_walk(const sim::Truth& truth, sim::Sensors& sensors);

}  // namespace tumble::bench
