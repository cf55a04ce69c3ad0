// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"
#include "sim/world/terrain/ground.hpp"
#include "sim/world/terrain/random_position.hpp"

namespace tumble::sim {

struct RockField {
  int count = 0;
  double largest_m = 0.3;
  /// The horizontal half axes of the rocks are uniform in [smallest_share, 1] * largest_m, and the vertical half axes
  /// are uniform in [0.75 smallest_share, 0.7] * largest_m.
  double smallest_share = 0.4;
  Rectangle area;
  Disc clear;
};

struct Rock {
  Eigen::Vector3d centre_W_m;
  Eigen::Vector3d half_axes_m;
  double yaw_rad;
};

std::vector<Rock> strew_rocks(Stream& stream, const RockField& field, const Ground& ground);
void add_rocks(mjSpec* spec, engine::World& world, const std::vector<Rock>& rocks);

}  // namespace tumble::sim
