// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// Numbers of an inertial measurement unit; the defaults are those of an ideal one at 100 Hz, without magnetometer.
std::span<const Parameter> imu_parameters();

/// Refuses resolved numbers that contradict each other: a kind of rail without a rail, spreads or offsets that leave no
/// rail, `wrap` together with `slow_recovery`, magnetic sources whose farthest distance is nearer than the nearest.
/// Throws InvalidSituation; `place` begins the message.
void check_imu_values(const Values& values, const std::string& place);

}  // namespace tumble::sim
