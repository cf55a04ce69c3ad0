// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/trunks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tumble::sim {

std::vector<Trunk> plant_trunks(Stream& stream, const Stand& stand, const Ground& ground) {
  constexpr double kBuried_m = 0.5;
  std::vector<Trunk> trunks;
  for (int i = 0; i < stand.count; ++i) {
    const double radius_m = stream.uniform(0.4, 1.0) * stand.largest_radius_m;
    const Eigen::Vector2d at = draw_position(stream, stand.area, "trunk", [&](const Eigen::Vector2d& position) {
      if (std::abs(position.y()) < stand.lane_half_width_m + radius_m) return false;
      if ((position - stand.clear.centre_m).norm() < stand.clear.radius_m + radius_m) return false;
      return std::none_of(trunks.begin(), trunks.end(), [&](const Trunk& other) {
        return (other.centre_W_m.head<2>() - position).norm() < stand.spacing_m;
      });
    });
    const double half_height_m = stream.uniform(1.5, 3.0);
    const double z_m = ground.height_m(at.x(), at.y()) + half_height_m - kBuried_m;
    trunks.push_back({{at.x(), at.y(), z_m}, radius_m, half_height_m});
  }
  return trunks;
}

void add_trunks(mjSpec* spec, engine::World& world, const std::vector<Trunk>& trunks) {
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    const float light = 0.9f + 0.1f * static_cast<float>(i % 3);
    add_surface(spec, world, "trunk_" + std::to_string(i), mjGEOM_CYLINDER, trunks[i].centre_W_m,
                {trunks[i].radius_m, trunks[i].half_height_m, 0.0}, 0.0,
                {0.36f * light, 0.26f * light, 0.17f * light, 1.0f});
  }
}

}  // namespace tumble::sim
