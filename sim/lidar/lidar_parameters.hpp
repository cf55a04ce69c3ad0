// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// Channels of a spinning lidar; elevation_01_rad is the first to fire.
inline constexpr int kSpinningChannels = 16;

/// Numbers of a lidar whose column of lasers turns about the z axis of L (RoboSense RS-16).
std::span<const Parameter> spinning_lidar_parameters();

/// Numbers of a lidar whose beam draws a rosette, one or several units side by side (Livox Mid-40, Mid-100).
std::span<const Parameter> rosette_lidar_parameters();

}  // namespace tumble::sim
