// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Writes the sensors' metadata as JSON. For each IMU: rate, stated ranges, noise densities and mounting T_BI. For each
/// lidar: period and mounting T_BL. Also gravity and the sphere's radius. Mountings have "translation_m" [x, y, z] and
/// "quaternion_xyzw", and include calibration errors.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
