// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/parameters.hpp"

namespace tumble::sim {

std::span<const Parameter> imu_parameters();

/// Throws InvalidSituation for these contradictions:
/// - a kind of saturation without a saturation level
/// - spreads of the saturation level, or zero offsets, that are so large that a saturation level could become zero
/// - `wrap` together with `slow_recovery`
/// - magnetic sources whose farthest distance is below the nearest distance
void check_imu_values(const Values& values, const std::string& place);

}  // namespace tumble::sim
