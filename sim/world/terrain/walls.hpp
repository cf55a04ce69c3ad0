// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world/terrain/ground.hpp"

namespace tumble::sim {

struct Block {
  double x_m = 0.0, y_m = 0.0;
  double half_x_m = 1.0, half_y_m = 1.0;  ///< half widths along the axes of the block
  /// Height of the block above the lowest ground at the block's corners and centre. The block also extends 1 m below
  /// the lowest ground.
  double height_m = 2.0;
  double yaw_rad = 0.0;
};

void add_block(mjSpec* spec, engine::World& world, const std::string& name, const Block& block, const Ground& ground,
               const Colour& colour);

}  // namespace tumble::sim
