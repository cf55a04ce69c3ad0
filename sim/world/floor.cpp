// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/world/ground.hpp"
#include "sim/world/room.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnFloorParameters = {
    Parameter{"patch_1_x_m", 0.0, -30, 30, "m", "centre of a patch with its own friction"},
    Parameter{"patch_1_y_m", 0.0, -30, 30, "m", "centre of a patch with its own friction"},
    Parameter{"patch_1_half_x_m", 0.0, 0, 30, "m", "half width of the patch along its own x axis; 0: no patch"},
    Parameter{"patch_1_half_y_m", 0.0, 0, 30, "m", "half width of the patch along its own y axis; 0: no patch"},
    Parameter{"patch_1_yaw_rad", 0.0, -3.2, 3.2, "rad", "rotation of the patch about z"},
    Parameter{"patch_1_friction", 0.05, 0, 2, "1", "sliding friction coefficient on the patch"},
    Parameter{"patch_2_x_m", 0.0, -30, 30, "m", "as patch 1"},
    Parameter{"patch_2_y_m", 0.0, -30, 30, "m", "as patch 1"},
    Parameter{"patch_2_half_x_m", 0.0, 0, 30, "m", "as patch 1"},
    Parameter{"patch_2_half_y_m", 0.0, 0, 30, "m", "as patch 1"},
    Parameter{"patch_2_yaw_rad", 0.0, -3.2, 3.2, "rad", "as patch 1"},
    Parameter{"patch_2_friction", 0.05, 0, 2, "1", "as patch 1"},
    Parameter{"patch_3_x_m", 0.0, -30, 30, "m", "as patch 1"},
    Parameter{"patch_3_y_m", 0.0, -30, 30, "m", "as patch 1"},
    Parameter{"patch_3_half_x_m", 0.0, 0, 30, "m", "as patch 1"},
    Parameter{"patch_3_half_y_m", 0.0, 0, 30, "m", "as patch 1"},
    Parameter{"patch_3_yaw_rad", 0.0, -3.2, 3.2, "rad", "as patch 1"},
    Parameter{"patch_3_friction", 0.05, 0, 2, "1", "as patch 1"},
    Parameter{"obstacle_1_kind", 0.0, 0.0, 3.0, "1",
              "kind of obstacle: 0: none; 1: bar with a round top; 2: board; 3: step up to a podium"},
    Parameter{"obstacle_1_x_m", 0.0, -30, 30, "m",
              "position of the obstacle's middle; for a podium, position of its edge"},
    Parameter{"obstacle_1_y_m", 0.0, -30, 30, "m", "position of the obstacle's middle"},
    Parameter{"obstacle_1_yaw_rad", 0.0, -3.2, 3.2, "rad", "rotation of the obstacle about z; 0: across the x axis"},
    Parameter{"obstacle_1_height_m", 0.015, 0.001, 0.08, "m", "height of the obstacle above the floor"},
    Parameter{"obstacle_1_depth_m", 0.1, 0.02, 10.0, "m",
              "width of a board or podium; a bar is a cylinder of 5 cm radius that is sunk into the floor"},
    Parameter{"obstacle_2_kind", 0.0, 0.0, 3.0, "1", "as obstacle 1"},
    Parameter{"obstacle_2_x_m", 0.0, -30, 30, "m", "as obstacle 1"},
    Parameter{"obstacle_2_y_m", 0.0, -30, 30, "m", "as obstacle 1"},
    Parameter{"obstacle_2_yaw_rad", 0.0, -3.2, 3.2, "rad", "as obstacle 1"},
    Parameter{"obstacle_2_height_m", 0.015, 0.001, 0.08, "m", "as obstacle 1"},
    Parameter{"obstacle_2_depth_m", 0.1, 0.02, 10.0, "m", "as obstacle 1"},
    Parameter{"obstacle_3_kind", 0.0, 0.0, 3.0, "1", "as obstacle 1"},
    Parameter{"obstacle_3_x_m", 0.0, -30, 30, "m", "as obstacle 1"},
    Parameter{"obstacle_3_y_m", 0.0, -30, 30, "m", "as obstacle 1"},
    Parameter{"obstacle_3_yaw_rad", 0.0, -3.2, 3.2, "rad", "as obstacle 1"},
    Parameter{"obstacle_3_height_m", 0.015, 0.001, 0.08, "m", "as obstacle 1"},
    Parameter{"obstacle_3_depth_m", 0.1, 0.02, 10.0, "m", "as obstacle 1"},
};
constexpr std::array kFloorParameters = joined(joined(kGroundParameters, kRoomParameters), kOwnFloorParameters);
constexpr int kPatches = 3, kObstacles = 3;
constexpr double kObstacleHalfWidth_m = 0.6;
constexpr double kBarRadius_m = 0.05;

void add_patches(mjSpec* spec, engine::World& world, const Values& values) {
  for (int i = 1; i <= kPatches; ++i) {
    const auto value = [&](const char* name) { return values.at("patch_" + std::to_string(i) + "_" + name); };
    const engine::FrictionPatch patch{value("x_m"),      value("y_m"),     value("half_x_m"),
                                      value("half_y_m"), value("yaw_rad"), value("friction")};
    if (patch.half_x_m <= 0.0 || patch.half_y_m <= 0.0) continue;
    world.patches.push_back(patch);
    add_mark(spec, patch, {0.55f, 0.75f, 0.95f, 1.0f});
  }
}

mjsGeom* add_bar(mjSpec* spec, engine::World& world, const std::string& name, const Eigen::Vector2d& at_m,
                 double yaw_rad, double height_m, const Colour& colour) {
  mjsGeom* geom = add_surface(spec, world, name, mjGEOM_CYLINDER, {at_m.x(), at_m.y(), height_m - kBarRadius_m},
                              {kBarRadius_m, kObstacleHalfWidth_m, 0.0}, 0.0, colour);
  const double half = std::sqrt(0.5), c = std::cos(yaw_rad / 2) * half, s = std::sin(yaw_rad / 2) * half;
  const double q[4] = {c, c, s, s};
  std::copy(q, q + 4, geom->quat);
  return geom;
}

void add_obstacles(mjSpec* spec, engine::World& world, const Values& values) {
  constexpr Colour kWood = {0.72f, 0.5f, 0.3f, 1.0f};
  for (int i = 1; i <= kObstacles; ++i) {
    const std::string name = "obstacle_" + std::to_string(i);
    const auto value = [&](const char* number) { return values.at(name + "_" + number); };
    const int kind = static_cast<int>(value("kind"));
    if (kind == 0) continue;
    const double yaw_rad = value("yaw_rad"), height_m = value("height_m"), half_depth_m = value("depth_m") / 2;
    const Eigen::Vector2d ahead(std::cos(yaw_rad), std::sin(yaw_rad));
    Eigen::Vector2d at(value("x_m"), value("y_m"));
    if (kind == 3) at += half_depth_m * ahead;
    mjsGeom* geom = kind == 1 ? add_bar(spec, world, name, at, yaw_rad, height_m, kWood)
                              : add_surface(spec, world, name, mjGEOM_BOX, {at.x(), at.y(), 0.0},
                                            {half_depth_m, kObstacleHalfWidth_m, height_m}, yaw_rad, kWood);
    set_ground_contact(geom, values);
  }
}

void build_floor(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  Stream uneven(seed, "terrain.unevenness");  // a separate stream, so that the furniture of a seed does not change
  const double half_m = values.at("room_half_m");
  add_ground(spec, world, values, half_m, half_m, nullptr, {0.62f, 0.6f, 0.57f, 1.0f}, uneven);
  add_room(spec, world, values, stream);
  add_obstacles(spec, world, values);
  add_patches(spec, world, values);
  add_daylight(spec);
}

}  // namespace

const WorldType& floor_world() {
  static const WorldType kType{
      {"floor", "room with a floor, walls, ceiling, furniture, obstacles and patches with their own friction",
       kFloorParameters},
      build_floor};
  return kType;
}

}  // namespace tumble::sim
