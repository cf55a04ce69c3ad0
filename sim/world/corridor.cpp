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

constexpr std::array kOwnCorridorParameters = {
    Parameter{"length_m", 16.0, 4.0, 60.0, "m", "length of the corridor along x, centred on the origin"},
    Parameter{"half_width_m", 1.4, 0.6, 5.0, "m", "half distance between the walls"},
    Parameter{"wall_height_m", 2.6, 1.0, 10.0, "m", "height of walls and ceiling"},
    Parameter{"bay_shortest_m", 1.0, 0.3, 10.0, "m",
              "minimum length of bare wall between two doors, pillars or niches"},
    Parameter{"bay_longest_m", 2.4, 0.3, 10.0, "m", "longest one"},
    Parameter{"niche_depth_m", 0.9, 0.2, 5.0, "m",
              "maximum depth of a niche; doors are recessed by a sixth to a half of this depth"},
    Parameter{"beam_count", 4, 0, 50, "1", "number of beams below the ceiling"},
};
constexpr std::array kCorridorParameters = joined(kGroundParameters, kOwnCorridorParameters);

constexpr double kHalfWall_m = 0.08;
constexpr Colour kWall = {0.85f, 0.84f, 0.8f, 1.0f}, kDoor = {0.45f, 0.3f, 0.2f, 1.0f},
                 kFrame = {0.3f, 0.34f, 0.4f, 1.0f}, kPillar = {0.6f, 0.62f, 0.66f, 1.0f},
                 kLocker = {0.35f, 0.5f, 0.55f, 1.0f};

class Side {
 public:
  Side(mjSpec* spec, engine::World& world, const Values& values, int side, Stream& stream)
      : spec_(spec),
        world_(world),
        values_(values),
        side_(side),
        stream_(stream),
        name_(side > 0 ? "left_" : "right_"),
        end_m_(values.at("length_m") / 2),
        at_m_(-end_m_) {}

  void build() {
    while (at_m_ < end_m_) {
      add_bare(stream_.uniform(values_.at("bay_shortest_m"),
                               std::max(values_.at("bay_longest_m"), values_.at("bay_shortest_m"))));
      if (end_m_ - at_m_ < 1.5) {
        add_bare(end_m_ - at_m_);
        break;
      }
      const double which = stream_.uniform();
      if (which < 0.45) {
        add_recess(0.95, stream_.uniform(0.16, 0.5) * values_.at("niche_depth_m"), kDoor, true);
      } else if (which < 0.7) {
        const double depth_m = stream_.uniform(0.5, 1.0) * values_.at("niche_depth_m");
        add_recess(stream_.uniform(0.6, 1.4), depth_m, kWall, false);
      } else {
        add_pillar();
      }
    }
  }

 private:
  void add(const char* what, double from_m, double to_m, double near_m, double far_m, double top_m,
           const Colour& colour) {
    const double half_m = values_.at("half_width_m");
    mjsGeom* geom = add_surface(spec_, world_, name_ + what + std::to_string(count_++), mjGEOM_BOX,
                                {0.5 * (from_m + to_m), side_ * (half_m + 0.5 * (near_m + far_m)), 0.5 * top_m},
                                {0.5 * (to_m - from_m), 0.5 * (far_m - near_m), 0.5 * top_m}, 0.0, colour);
    if (side_ < 0) geom->group = kUnseenInPictures;  // pictures are taken from the right side
  }

  void add_bare(double length_m) {
    const double to_m = std::min(at_m_ + length_m, end_m_);
    if (to_m - at_m_ < 1e-3) return;
    add("wall_", at_m_, to_m, 0.0, 2 * kHalfWall_m, values_.at("wall_height_m"), kWall);
    at_m_ = to_m;
  }

  void add_recess(double width_m, double depth_m, const Colour& colour, bool door) {
    const double to_m = at_m_ + width_m, top_m = values_.at("wall_height_m");
    add(door ? "door_" : "niche_", at_m_, to_m, depth_m, depth_m + 2 * kHalfWall_m, top_m, colour);
    add("reveal_", at_m_ - kHalfWall_m, at_m_, 0.0, depth_m + 2 * kHalfWall_m, top_m, kWall);
    add("reveal_", to_m, to_m + kHalfWall_m, 0.0, depth_m + 2 * kHalfWall_m, top_m, kWall);
    if (door) {
      add("post_", at_m_ - 0.08, at_m_ + 0.02, -0.05, 0.0, 2.1, kFrame);
      add("post_", to_m - 0.02, to_m + 0.08, -0.05, 0.0, 2.1, kFrame);
    } else if (stream_.uniform() < 0.5) {
      add("locker_", at_m_ + 0.1, at_m_ + 0.5, depth_m - 0.3, depth_m, stream_.uniform(0.6, 1.8), kLocker);
    }
    at_m_ = to_m;
  }

  void add_pillar() {
    const double width_m = stream_.uniform(0.2, 0.4);
    add("pillar_", at_m_, at_m_ + width_m, -stream_.uniform(0.1, 0.25), 2 * kHalfWall_m, values_.at("wall_height_m"),
        kPillar);
    at_m_ += width_m;
  }

  mjSpec* spec_;
  engine::World& world_;
  const Values& values_;
  int side_;
  Stream& stream_;
  std::string name_;
  double end_m_, at_m_;
  int count_ = 0;
};

void add_ends(mjSpec* spec, engine::World& world, const Values& values) {
  const double half_height_m = values.at("wall_height_m") / 2;
  const double half_width_m = values.at("half_width_m") + values.at("niche_depth_m") + 2 * kHalfWall_m;
  const double x_m = values.at("length_m") / 2 + kHalfWall_m;
  add_surface(spec, world, "end_front", mjGEOM_BOX, {x_m, 0, half_height_m}, {kHalfWall_m, half_width_m, half_height_m},
              0.0, kWall);
  add_surface(spec, world, "end_back", mjGEOM_BOX, {-x_m, 0, half_height_m}, {kHalfWall_m, half_width_m, half_height_m},
              0.0, kWall);
  add_surface(spec, world, "end_front_door", mjGEOM_BOX, {x_m - 0.12, 0.3, 1.0}, {0.04, 0.45, 1.0}, 0.0, kDoor);
  add_surface(spec, world, "end_back_door", mjGEOM_BOX, {0.12 - x_m, -0.2, 1.0}, {0.04, 0.45, 1.0}, 0.0, kDoor);
}

void add_beams(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double half_m = values.at("length_m") / 2;
  for (int i = 0; i < static_cast<int>(values.at("beam_count")); ++i) {
    const double half_drop_m = stream.uniform(0.06, 0.15);
    const double half_length_m = stream.uniform(0.05, 0.15), x_m = stream.uniform(-half_m, half_m);
    mjsGeom* geom = add_surface(spec, world, "beam_" + std::to_string(i), mjGEOM_BOX,
                                {x_m, 0.0, values.at("wall_height_m") - half_drop_m},
                                {half_length_m, values.at("half_width_m"), half_drop_m}, 0.0, kPillar);
    geom->group = kUnseenInPictures;
  }
}

void build_corridor(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  Stream uneven(seed, "terrain.unevenness");
  const double half_x_m = values.at("length_m") / 2 + 2 * kHalfWall_m;
  const double half_y_m = values.at("half_width_m") + values.at("niche_depth_m") + 2 * kHalfWall_m;
  world.half_extent_m = std::max(half_x_m, half_y_m);
  add_ground(spec, world, values, half_x_m, half_y_m, nullptr, {0.62f, 0.6f, 0.57f, 1.0f}, uneven);
  Side(spec, world, values, 1, stream).build();
  Side(spec, world, values, -1, stream).build();
  add_ends(spec, world, values);
  add_beams(spec, world, values, stream);
  add_ceiling(spec, world, half_x_m, half_y_m, values.at("wall_height_m"));
  add_daylight(spec);
}

}  // namespace

const WorldType& corridor_world() {
  static const WorldType kType{
      {"corridor", "corridor along x with doors, niches, pillars and beams; both ends are closed", kCorridorParameters},
      build_corridor};
  return kType;
}

}  // namespace tumble::sim
