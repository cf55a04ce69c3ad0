// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/hillside.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/terrain/relief.hpp"
#include "sim/world/terrain/rocks.hpp"
#include "sim/world/terrain/trunks.hpp"
#include "sim/world/terrain/walls.hpp"

namespace tumble::sim::hillside {

namespace {

constexpr double kReach_m = 18.0;  // distance from objects to the rim of the world

double from_start_m(double x_m, double y_m) {
  return std::hypot(x_m - kStart_x_m, y_m);
}

}  // namespace

void roughen(Ground& ground, const Values& values, std::uint64_t seed, const Share& share) {
  Ground rough(ground.side(), ground.half_extent_m());
  Stream relief_stream(seed, "terrain.relief"), bump_stream(seed, "terrain.bumps");
  const double shortest_m = values.at("relief_shortest_m");
  const Relief relief(relief_stream,
                      {values.at("relief_m"), shortest_m, std::max(shortest_m, values.at("relief_longest_m")),
                       values.at("relief_exponent"), values.at("relief_ruled") > 0.5});
  if (values.at("relief_m") > 0.0) rough.transform([&](double x, double y, double) { return relief.height_m(x, y); });
  if (values.at("bump_height_m") > 0.0)
    add_bumps(rough, bump_stream, static_cast<int>(values.at("bump_count")), values.at("bump_height_m"));
  // The relief fades to zero in a disc around the start. If the relief is constant along y, the relief fades in a strip
  // along y instead of a disc, because a disc would be a feature for the lidar.
  const bool ruled = values.at("relief_ruled") > 0.5;
  int node = 0;
  ground.transform([&](double x, double y, double height_m) {
    const double added_m = rough.node_m(node / ground.side(), node % ground.side());
    ++node;
    const double away_m = ruled ? std::abs(x - kStart_x_m) : from_start_m(x, y);
    return height_m + fade(away_m, 0.7, 1.9) * share(x, y) * added_m;
  });
}

void cover(mjSpec* spec, engine::World& world, const Ground& ground, const Values& values, std::uint64_t seed,
           double rocks_from_x_m, double rocks_to_x_m) {
  world.half_extent_m = kHalfExtent_m;
  world.start_W_m = {kStart_x_m, 0.0, ground.height_m(kStart_x_m, 0.0)};
  ground.add_to(spec, world, "terrain", {0.42f, 0.52f, 0.28f, 1.0f});

  Stream rock_stream(seed, "terrain.rocks"), trunk_stream(seed, "terrain.trunks");
  RockField rocks;
  rocks.count = static_cast<int>(values.at("rock_count"));
  rocks.largest_m = values.at("rock_size_m");
  const double half_width_m = values.at("rock_half_width_m");
  rocks.area = {std::max(-kReach_m, rocks_from_x_m), std::min(kReach_m, rocks_to_x_m), -half_width_m, half_width_m};
  rocks.clear = {world.start_W_m.head<2>(), 1.0};
  add_rocks(spec, world, strew_rocks(rock_stream, rocks, ground));

  Stand stand;
  stand.count = static_cast<int>(values.at("trunk_count"));
  stand.largest_radius_m = values.at("trunk_radius_m");
  stand.lane_half_width_m = values.at("clear_half_width_m");
  const double stand_half_width_m = values.at("trunk_half_width_m");
  stand.area = {-kReach_m, kReach_m, -stand_half_width_m, stand_half_width_m};
  stand.clear = {world.start_W_m.head<2>(), 1.8};
  add_trunks(spec, world, plant_trunks(trunk_stream, stand, ground));

  if (values.at("buildings") > 0.5) {
    add_block(spec, world, "building", {15.5, -9.0, 2.0, 4.0, 4.0, 0.2}, ground, {0.8f, 0.76f, 0.68f, 1.0f});
    add_block(spec, world, "wall", {2.0, 17.0, 7.0, 0.15, 2.0, -0.1}, ground, {0.66f, 0.62f, 0.58f, 1.0f});
  }
  add_daylight(spec);
}

}  // namespace tumble::sim::hillside
