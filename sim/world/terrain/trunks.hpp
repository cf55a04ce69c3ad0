// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"
#include "sim/world/terrain/ground.hpp"
#include "sim/world/terrain/random_position.hpp"

namespace tumble::sim {

struct Stand {
  int count = 0;
  double largest_radius_m = 0.15;  ///< uniform from 0.4 times this value
  double spacing_m = 0.8;          ///< minimum distance between two axes
  double lane_half_width_m = 0.0;  ///< no tree is closer to y = 0
  Rectangle area;
  Disc clear;
};

struct Trunk {
  Eigen::Vector3d centre_W_m;
  double radius_m;
  double half_height_m;  ///< uniform in [1.5, 3] m
};

std::vector<Trunk> plant_trunks(Stream& stream, const Stand& stand, const Ground& ground);
void add_trunks(mjSpec* spec, engine::World& world, const std::vector<Trunk>& trunks);

}  // namespace tumble::sim
