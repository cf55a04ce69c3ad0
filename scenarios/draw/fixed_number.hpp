// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Fixes one number of a scenario, whatever it was drawn from. Every other number stays what it is in each draw: each
/// comes from a stream of its own. `key` is the number's place: "duration_s", "world.slope_rad", "robot.mass_kg",
/// "motion.rest_s", "sensors.imu.output_rate_hz", "sensors.lidar.mount_error.yaw_rad".
///
/// Throws BadInput, without file and line: no such number (the nearest named), a value that is out of bounds.
void fix_number(Scenario& scenario, const std::string& key, double value);

}  // namespace tumble::scenarios
