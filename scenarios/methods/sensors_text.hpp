// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns the sensors' metadata as JSON. Each IMU has its rate, stated ranges, noise densities and mounting T_BI. Each
/// lidar has its period and mounting T_BL. The JSON text also contains gravity and the sphere's radius. Mountings have
/// "translation_m" [x, y, z] and "quaternion_xyzw", and include calibration errors.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
