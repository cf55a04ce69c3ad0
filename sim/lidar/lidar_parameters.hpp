// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// kSpinningChannels is the number of channels of a spinning lidar. elevation_01_rad belongs to the channel that fires
/// first.
inline constexpr int kSpinningChannels = 16;

/// Returns the parameters of a lidar with a column of lasers that rotates about the z axis of L (RoboSense RS-16).
std::span<const Parameter> spinning_lidar_parameters();

/// Returns the parameters of a lidar with a column of many evenly spaced rings (Ouster, Hesai, RoboSense Helios).
std::span<const Parameter> column_lidar_parameters();

/// Returns the parameters of a lidar with a rosette pattern and one or several units next to each other (Livox Mid-40,
/// Mid-100).
std::span<const Parameter> rosette_lidar_parameters();

}  // namespace tumble::sim
