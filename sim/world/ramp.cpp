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

constexpr std::array kOwnRampParameters = {
    Parameter{"slope_rad", 0.12, 0.01, 0.5, "rad", "angle of the upward ramp along +x"},
    Parameter{"ramp_x_m", -1.0, -20.0, 20.0, "m", "x position of the foot of the ramp"},
    Parameter{"ramp_length_m", 1.5, 0.3, 20.0, "m", "horizontal length of the ramp"},
    Parameter{"plateau_m", 1.0, 0.1, 20.0, "m", "length of the plateau above the ramp"},
    Parameter{"slope_down_rad", 0.12, 0.01, 1.2, "rad", "angle of the downward ramp on the far side"},
};
constexpr std::array kRampParameters = joined(joined(kGroundParameters, kRoomParameters), kOwnRampParameters);
constexpr double kHalfWidth_m = 1.5;
constexpr double kHalfThickness_m = 0.15;

void add_slab(mjSpec* spec, engine::World& world, const Values& values, const std::string& name,
              const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  const Eigen::Vector2d along = (to_m - from_m).normalized();
  const Eigen::Vector2d middle = 0.5 * (from_m + to_m) - kHalfThickness_m * Eigen::Vector2d(-along.y(), along.x());
  mjsGeom* geom =
      add_surface(spec, world, name, mjGEOM_BOX, {middle.x(), 0.0, middle.y()},
                  {0.5 * (to_m - from_m).norm(), kHalfWidth_m, kHalfThickness_m}, 0.0, {0.7f, 0.62f, 0.5f, 1.0f});
  const double tilt_rad = std::atan2(along.y(), along.x());  // upward: negative rotation about y
  geom->quat[0] = std::cos(tilt_rad / 2);
  geom->quat[2] = -std::sin(tilt_rad / 2);
  geom->quat[1] = geom->quat[3] = 0.0;
  set_ground_contact(geom, values);
}

void build_ramp(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  Stream uneven(seed, "terrain.unevenness");
  const double half_m = values.at("room_half_m");
  add_ground(spec, world, values, half_m, half_m, nullptr, {0.62f, 0.6f, 0.57f, 1.0f}, uneven);
  add_room(spec, world, values, stream);

  const double height_m = values.at("ramp_length_m") * std::tan(values.at("slope_rad"));
  const Eigen::Vector2d foot(values.at("ramp_x_m"), 0.0), top(foot.x() + values.at("ramp_length_m"), height_m),
      edge(top.x() + values.at("plateau_m"), height_m),
      end(edge.x() + height_m / std::tan(values.at("slope_down_rad")), 0.0);
  add_slab(spec, world, values, "ramp_up", foot, top);
  add_slab(spec, world, values, "plateau", top, edge);
  add_slab(spec, world, values, "ramp_down", edge, end);
  add_daylight(spec);
}

}  // namespace

const WorldType& ramp_world() {
  static const WorldType kType{
      {"ramp", "room with an upward ramp along +x, a plateau and a downward ramp", kRampParameters}, build_ramp};
  return kType;
}

}  // namespace tumble::sim
