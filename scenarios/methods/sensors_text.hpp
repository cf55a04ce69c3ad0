// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What an estimator must know of the sensors beside their readings, as JSON: of each IMU rate, stated ranges, noise
/// densities and mounting T_BI, of each lidar period and mounting T_BL, gravity, the sphere's radius. Mountings are
/// "translation_m" [x, y, z] and "quaternion_xyzw"; the calibration that estimators are given, its errors included.
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
