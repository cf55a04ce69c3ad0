// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/walls.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

void add_block(mjSpec* spec, engine::World& world, const std::string& name, const Block& block, const Ground& ground,
               const Colour& colour) {
  constexpr double kBuried_m = 1.0;
  const double c = std::cos(block.yaw_rad), s = std::sin(block.yaw_rad);
  double foot_m = ground.height_m(block.x_m, block.y_m);
  for (const double u : {-block.half_x_m, block.half_x_m}) {
    for (const double v : {-block.half_y_m, block.half_y_m}) {
      foot_m = std::min(foot_m, ground.height_m(block.x_m + c * u - s * v, block.y_m + s * u + c * v));
    }
  }
  const double half_m = 0.5 * (block.height_m + kBuried_m);
  add_surface(spec, world, name, mjGEOM_BOX, {block.x_m, block.y_m, foot_m - kBuried_m + half_m},
              {block.half_x_m, block.half_y_m, half_m}, block.yaw_rad, colour);
}

}  // namespace tumble::sim
