// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/recording.hpp"

namespace tumble::bench {

/// Puts three people into a recording's lidar returns: upright cylinders of 0.5 m by 1.75 m that walk at 1.2 m/s on
/// circles about the place where the robot starts, from the ground that is level with it. What a ray meets on them
/// takes the place of what it met behind; the noise of the range stays. The truth is not changed: they are no surface
/// of a map.
void let_people_walk(const sim::Truth& truth, sim::Sensors& sensors);

}  // namespace tumble::bench
