// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// Number of lasers of a spinning lidar. The parameter elevation_01_rad is the elevation of the laser that fires first.
inline constexpr int kSpinningChannels = 16;

std::span<const Parameter> spinning_lidar_parameters();

std::span<const Parameter> column_lidar_parameters();

std::span<const Parameter> rosette_lidar_parameters();

}  // namespace tumble::sim
