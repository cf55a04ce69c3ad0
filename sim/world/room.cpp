// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace tumble::sim {

namespace {

constexpr double kThickness_m = 0.1;

void add_walls(mjSpec* spec, engine::World& world, const Values& values) {
  const double half_m = values.at("room_half_m"), half_height_m = values.at("wall_height_m") / 2;
  const std::array<const char*, 4> names = {"wall_front", "wall_left", "wall_back", "wall_right"};
  for (int i = 0; i < 4; ++i) {
    const double yaw = i * std::numbers::pi / 2;
    mjsGeom* wall =
        add_surface(spec, world, names[i], mjGEOM_BOX,
                    {(half_m + kThickness_m) * std::cos(yaw), (half_m + kThickness_m) * std::sin(yaw), half_height_m},
                    {kThickness_m, half_m, half_height_m}, yaw, {0.85f, 0.84f, 0.8f, 1.0f});
    if (i == 3 && values.at("ceiling") > 0.5) wall->group = kUnseenInPictures;  // pictures look from the right
  }
}

void add_furniture(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double reach_m = values.at("room_half_m") - 0.5;
  const auto place = [&] {
    Eigen::Vector2d at;
    do {
      at = {stream.uniform(-reach_m, reach_m), stream.uniform(-reach_m, reach_m)};
    } while (at.norm() < std::min(values.at("clear_radius_m"), reach_m));
    return at;
  };
  for (int i = 0; i < static_cast<int>(values.at("pillar_count")); ++i) {
    const Eigen::Vector2d at = place();
    const double half_height_m = values.at("wall_height_m") / 2;
    add_surface(spec, world, "pillar_" + std::to_string(i), mjGEOM_CYLINDER, {at.x(), at.y(), half_height_m},
                {stream.uniform(0.08, 0.2), half_height_m, 0.0}, 0.0, {0.6f, 0.62f, 0.66f, 1.0f});
  }
  for (int i = 0; i < static_cast<int>(values.at("box_count")); ++i) {
    const Eigen::Vector2d at = place();
    const double half_z_m = stream.uniform(0.15, 0.5), half_y_m = stream.uniform(0.15, 0.4);
    const Eigen::Vector3d size(stream.uniform(0.15, 0.4), half_y_m, half_z_m);
    add_surface(spec, world, "box_" + std::to_string(i), mjGEOM_BOX, {at.x(), at.y(), size.z()}, size,
                stream.uniform(0.0, std::numbers::pi), {0.7f, 0.55f, 0.38f, 1.0f});
  }
}

void add_shelves(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double half_m = values.at("room_half_m");
  for (int i = 0; i < static_cast<int>(values.at("shelf_count")); ++i) {
    const double yaw = i % 4 * std::numbers::pi / 2;
    const double half_z_m = std::min(stream.uniform(0.4, 1.0), values.at("wall_height_m") / 2);
    const double half_y_m = stream.uniform(0.4, 1.0);
    const Eigen::Vector3d size(stream.uniform(0.15, 0.3), half_y_m, half_z_m);
    const double out_m = half_m - size.x(), along_m = stream.uniform(-1.0, 1.0) * (half_m - size.y());
    add_surface(
        spec, world, "shelf_" + std::to_string(i), mjGEOM_BOX,
        {out_m * std::cos(yaw) - along_m * std::sin(yaw), out_m * std::sin(yaw) + along_m * std::cos(yaw), size.z()},
        size, yaw, {0.5f, 0.42f, 0.36f, 1.0f});
  }
}

}  // namespace

void add_ceiling(mjSpec* spec, engine::World& world, double half_x_m, double half_y_m, double height_m) {
  mjsGeom* geom = add_surface(spec, world, "ceiling", mjGEOM_BOX, {0, 0, height_m + kThickness_m},
                              {half_x_m, half_y_m, kThickness_m}, 0.0, {0.9f, 0.9f, 0.88f, 1.0f});
  geom->group = kUnseenInPictures;
}

void add_room(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double half_m = values.at("room_half_m");
  world.half_extent_m = half_m;
  add_walls(spec, world, values);
  add_furniture(spec, world, values, stream);
  add_shelves(spec, world, values, stream);
  if (values.at("ceiling") > 0.5) add_ceiling(spec, world, half_m, half_m, values.at("wall_height_m"));
}

}  // namespace tumble::sim
