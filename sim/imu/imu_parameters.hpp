// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// Returns the parameters of a simulated IMU. The default values describe an ideal device at 100 Hz, without a
/// magnetometer.
std::span<const Parameter> imu_parameters();

/// Checks that the resolved parameters of an IMU do not contradict each other. Throws InvalidSituation for the
/// contradictions below; the message starts with `place`.
/// - a kind of saturation without a saturation level
/// - spreads or offsets that leave no saturation level
/// - `wrap` together with `slow_recovery`
/// - magnetic sources whose farthest distance is below the nearest distance
void check_imu_values(const Values& values, const std::string& place);

}  // namespace tumble::sim
