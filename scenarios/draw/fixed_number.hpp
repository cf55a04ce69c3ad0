// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Replaces one random parameter by a constant; all others keep their values, because each has its own random stream.
/// `key` names the parameter, for example "duration_s", "world.slope_rad", "sensors.imu.output_rate_hz" or
/// "sensors.lidar.mount_error.yaw_rad".
void fix_number(Scenario& scenario, const std::string& key, double value);

}  // namespace tumble::scenarios
