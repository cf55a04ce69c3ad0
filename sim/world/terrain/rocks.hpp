// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"
#include "sim/world/terrain/ground.hpp"
#include "sim/world/terrain/random_position.hpp"

namespace tumble::sim {

/// Where rocks lie and how large they are.
struct RockField {
  int count = 0;
  double largest_m = 0.3;       ///< largest half axis
  double smallest_share = 0.4;  ///< half axes along the ground are uniform in [smallest_share, 1] * largest_m, heights
                                ///< in [0.75 smallest_share, 0.7] * largest_m
  Rectangle area;
  Disc clear;  ///< no rock reaches into it
};

/// An ellipsoid, more than a third of it buried.
struct Rock {
  Eigen::Vector3d centre_W_m;
  Eigen::Vector3d half_axes_m;
  double yaw_rad;
};

/// Rocks on the ground, evenly over the area; they may lie on each other. Throws InvalidSituation when the clear disc
/// leaves no room for them.
std::vector<Rock> strew_rocks(Stream& stream, const RockField& field, const Ground& ground);
/// Adds them as surfaces "rock_0", "rock_1", ...
void add_rocks(mjSpec* spec, engine::World& world, const std::vector<Rock>& rocks);

}  // namespace tumble::sim
