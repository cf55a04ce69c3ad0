// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns gravity, the sphere's radius and the sensors as JSON. An IMU has sample rate, ranges, noise densities and
/// mounting T_BI. A lidar has period and mounting T_BL. A mounting has "translation_m" [x, y, z] and "quaternion_xyzw",
/// and includes calibration errors.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
