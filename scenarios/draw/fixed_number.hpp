// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Replaces one number of a scenario by a constant. All other numbers keep their draws, because each has its own
/// stream. `key` is the number's place: "duration_s", "world.slope_rad", "robot.mass_kg", "motion.rest_s",
/// "sensors.imu.output_rate_hz", "sensors.lidar.mount_error.yaw_rad".
///
/// Throws BadInput, without file and line: unknown number (suggests the nearest name) or value out of bounds.
void fix_number(Scenario& scenario, const std::string& key, double value);

}  // namespace tumble::scenarios
