// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/built_situation.hpp"

namespace tumble::sim {

/// The lidar's mirror of a world beside the engine's own rays (mj_ray), ray by ray.
struct RayDisagreement {
  std::int64_t rays = 0;
  std::int64_t hits = 0;  ///< of the engine's rays
  std::int64_t other_surface =
      0;  ///< the mirror names a surface that is not where the engine's ray ends, or one names none
  double largest_difference_m = 0.0;  ///< of the ranges, where both name the same surface
};

struct RayTrialOptions {
  int rays = 2000;
  std::uint64_t seed = 1;
  double mirror_shift_m = 0.0;  ///< lifts the rays of the mirror alone: an error, for showing that it is found
  int surface_shift = 0;        ///< added to the mirror's surface ids, round the list of surfaces: another error
};

/// Casts random rays in all directions, both ways: half of them from 0.2 to 3 m above whatever stands anywhere in the
/// world, half from near the place where the robot begins. The robot is left out. A ray of the
/// engine costs up to 0.3 ms on a height field. Throws InvalidSituation on a geom that has no surface.
RayDisagreement compare_rays(const BuiltSituation& built, const RayTrialOptions& options);

}  // namespace tumble::sim
