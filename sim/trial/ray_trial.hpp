// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/built_situation.hpp"

namespace tumble::sim {

struct RayDisagreement {
  std::int64_t rays = 0;
  std::int64_t hits = 0;
  /// number of rays for which the lidar simulation and MuJoCo hit different surfaces, or only one of them has a hit
  std::int64_t other_surface = 0;
  double largest_difference_m = 0.0;  ///< largest difference of the ranges to the same surface
};

struct RayTrialOptions {
  int rays = 2000;
  std::uint64_t seed = 1;
  /// displacement of the lidar's rays: a deliberate error that the comparison with MuJoCo must detect
  double mirror_shift_m = 0.0;
  int surface_shift = 0;  ///< change of the surface ids: another deliberate error
};

/// Casts random rays in all directions with the lidar's ray scene and with MuJoCo, without the robot. Half of the rays
/// start 0.2 to 3 m above the surface at random positions of the world, half near the robot's start.
RayDisagreement compare_rays(const BuiltSituation& built, const RayTrialOptions& options);

}  // namespace tumble::sim
