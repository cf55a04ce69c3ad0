// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// Parameters of an inertial measurement unit. The defaults describe an ideal device at 100 Hz without magnetometer.
std::span<const Parameter> imu_parameters();

/// Refuses resolved numbers that contradict each other: a kind of rail without a limit, spreads or offsets that leave
/// no limit, `wrap` together with `slow_recovery`, or magnetic sources whose farthest distance is below the nearest.
/// Throws InvalidSituation; the message starts with `place`.
void check_imu_values(const Values& values, const std::string& place);

}  // namespace tumble::sim
