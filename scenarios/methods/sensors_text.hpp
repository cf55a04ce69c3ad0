// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// The JSON text contains gravity, the sphere's radius, each IMU with sample rate, ranges, noise densities and mounting
/// T_BI, and each lidar with period and mounting T_BL. A mounting is the calibrated, not the true pose, as
/// "translation_m" [x, y, z] and "quaternion_xyzw".
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
