// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns the properties of the sensors as JSON: gravity, the sphere's radius, rate, ranges, noise densities and
/// mounting T_BI of each IMU, period and mounting T_BL of each lidar. A mounting has "translation_m" [x, y, z] and
/// "quaternion_xyzw", and includes calibration errors.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
