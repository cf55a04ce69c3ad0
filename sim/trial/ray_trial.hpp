// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/built_situation.hpp"

namespace tumble::sim {

struct RayDisagreement {
  std::int64_t rays = 0;
  std::int64_t hits = 0;
  /// number of rays for which lidar simulation and MuJoCo hit different surfaces, or for which only one of the two has
  /// a hit
  std::int64_t other_surface = 0;
  double largest_difference_m = 0.0;  ///< largest difference of the ranges to the same surface
};

struct RayTrialOptions {
  int rays = 2000;
  std::uint64_t seed = 1;
  /// displacement of the lidar's rays, as a deliberate error that the comparison with MuJoCo must detect
  double mirror_shift_m = 0.0;
  int surface_shift = 0;  ///< change of the surface ids: another deliberate error
};

/// Casts random rays in all directions without the robot, once with the ray scene of the lidar simulation and once with
/// MuJoCo. Half of the rays start at random positions of the world, 0.2 to 3 m above the surface, and the other half
/// start near the robot's start position.
RayDisagreement compare_rays(const BuiltSituation& built, const RayTrialOptions& options);

}  // namespace tumble::sim
