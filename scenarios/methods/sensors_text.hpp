// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns the properties of the sensors as JSON. The JSON of an IMU contains its rate, ranges, noise densities and
/// mounting T_BI. The JSON of a lidar contains its period and mounting T_BL. The JSON text also contains gravity and
/// the sphere's radius. Each mounting has "translation_m" [x, y, z] and "quaternion_xyzw", and includes calibration
/// errors.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
