// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/rocks.hpp"

#include <algorithm>
#include <numbers>
#include <string>

namespace tumble::sim {

std::vector<Rock> strew_rocks(Stream& stream, const RockField& field, const Ground& ground) {
  std::vector<Rock> rocks;
  for (int i = 0; i < field.count; ++i) {
    const double low = field.smallest_share;
    const double a_m = stream.uniform(low, 1.0) * field.largest_m, b_m = stream.uniform(low, 1.0) * field.largest_m;
    const Eigen::Vector3d half_axes_m(a_m, b_m, stream.uniform(0.75 * low, 0.7) * field.largest_m);
    const double reach_m = field.clear.radius_m + half_axes_m.head<2>().maxCoeff();
    const Eigen::Vector2d at = draw_position(stream, field.area, "rock", [&](const Eigen::Vector2d& position) {
      return (position - field.clear.centre_m).norm() >= reach_m;
    });
    const double z_m = ground.height_m(at.x(), at.y()) + 0.2 * half_axes_m.z();
    rocks.push_back({{at.x(), at.y(), z_m}, half_axes_m, stream.uniform(0.0, std::numbers::pi)});
  }
  return rocks;
}

void add_rocks(mjSpec* spec, engine::World& world, const std::vector<Rock>& rocks) {
  for (std::size_t i = 0; i < rocks.size(); ++i) {
    const float light = 0.42f + 0.04f * static_cast<float>(i % 5);
    add_surface(spec, world, "rock_" + std::to_string(i), mjGEOM_ELLIPSOID, rocks[i].centre_W_m, rocks[i].half_axes_m,
                rocks[i].yaw_rad, {light, 0.97f * light, 0.9f * light, 1.0f});
  }
}

}  // namespace tumble::sim
