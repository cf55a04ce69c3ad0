// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/parameters.hpp"

namespace tumble::sim {

std::span<const Parameter> imu_parameters();

/// Throws InvalidSituation if the parameters of an IMU contain one of these contradictions:
/// - a kind of saturation without a saturation level
/// - random spreads of the saturation level, or random zero offsets, that are so large that a saturation level could
///   become zero
/// - `wrap` together with `slow_recovery`
/// - magnetic sources whose farthest distance is below the nearest distance
void check_imu_values(const Values& values, const std::string& place);

}  // namespace tumble::sim
