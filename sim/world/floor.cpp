// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/random/stream.hpp"
#include "sim/world/geoms.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"friction", 0.6, 0.0, 2.0, "1", "sliding friction of the floor outside of the patches"},
    Parameter{"spin_friction_m", 0.0005, 0.0, 0.1, "m",
              "friction moment about the normal over normal force (MuJoCo's torsional friction)"},
    Parameter{"room_half_m", 5.0, 2.5, 30.0, "m", "half width of the square room"},
    Parameter{"wall_height_m", 2.5, 0.2, 10.0, "m", "height of the four walls"},
    Parameter{"pillar_count", 6, 0, 100, "1", "upright pillars, for the lidar"},
    Parameter{"box_count", 8, 0, 100, "1", "boxes on the floor, for the lidar"},
    Parameter{"clear_radius_m", 2.4, 0.5, 20.0, "m", "neither pillar nor box comes closer to the start than this"},
    Parameter{"patch_1_x_m", 0.0, -30, 30, "m", "centre of a patch of other friction"},
    Parameter{"patch_1_y_m", 0.0, -30, 30, "m", "centre of a patch of other friction"},
    Parameter{"patch_1_half_x_m", 0.0, 0, 30, "m", "half width along its own x axis; 0: no patch"},
    Parameter{"patch_1_half_y_m", 0.0, 0, 30, "m", "half width along its own y axis; 0: no patch"},
    Parameter{"patch_1_yaw_rad", 0.0, -3.2, 3.2, "rad", "turn of the patch about z"},
    Parameter{"patch_1_friction", 0.05, 0, 2, "1", "sliding friction within the patch"},
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
};
constexpr int kPatches = 3;

void add_room(mjSpec* spec, engine::World& world, const Values& values) {
  const double half_m = values.at("room_half_m"), half_height_m = values.at("wall_height_m") / 2;
  constexpr double kThickness_m = 0.1;
  const std::array<const char*, 4> names = {"wall_front", "wall_left", "wall_back", "wall_right"};
  for (int i = 0; i < 4; ++i) {
    const double yaw = i * std::numbers::pi / 2;
    add_surface(spec, world, names[i], mjGEOM_BOX,
                {(half_m + kThickness_m) * std::cos(yaw), (half_m + kThickness_m) * std::sin(yaw), half_height_m},
                {kThickness_m, half_m, half_height_m}, yaw, {0.85f, 0.84f, 0.8f, 1.0f});
  }
}

void add_furniture(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double reach_m = values.at("room_half_m") - 0.5;
  // a clear disc as wide as the room still leaves its corners, so that a place is always found
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
    const Eigen::Vector3d size(stream.uniform(0.15, 0.4), stream.uniform(0.15, 0.4), stream.uniform(0.15, 0.5));
    add_surface(spec, world, "box_" + std::to_string(i), mjGEOM_BOX, {at.x(), at.y(), size.z()}, size,
                stream.uniform(0.0, std::numbers::pi), {0.7f, 0.55f, 0.38f, 1.0f});
  }
}

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

void build(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  world.half_extent_m = values.at("room_half_m");
  mjsGeom* floor = add_surface(spec, world, "floor", mjGEOM_PLANE, {0, 0, 0},
                               {world.half_extent_m, world.half_extent_m, 1.0}, 0.0, {0.62f, 0.6f, 0.57f, 1.0f});
  floor->solmix =
      0.0;  // the softness is the robot's; of the two frictions the larger one counts, and a sphere has none
  floor->condim = 4;
  floor->friction[0] = values.at("friction");
  floor->friction[1] = values.at("spin_friction_m");
  add_room(spec, world, values);
  add_furniture(spec, world, values, stream);
  add_patches(spec, world, values);
  add_daylight(spec);
}

}  // namespace

const WorldType& floor_world() {
  static const WorldType kType{
      {"floor", "room with a level floor, walls, pillars, boxes and patches of other friction", kParameters}, build};
  return kType;
}

}  // namespace tumble::sim
