// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/world/ground.hpp"
#include "sim/world/room.hpp"
#include "sim/world/terrain/relief.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnTubeParameters = {
    Parameter{"length_m", 16.0, 4.0, 60.0, "m", "length of the tube along x, centred on the origin"},
    Parameter{"half_width_m", 1.9, 0.8, 10.0, "m", "half width at the ground"},
    Parameter{"height_m", 2.2, 1.0, 10.0, "m", "height from the ground to the top of the tube"},
    Parameter{"gutter_m", 0.1, 0.0, 1.0, "m", "height by which the ground rises from the middle to the walls"},
    Parameter{"wall_roughness_m", 0.08, 0.0, 0.5, "m",
              "root mean square height of the walls' unevenness, with wavelengths of 0.3 to 3 m"},
    Parameter{"bend_m", 0.3, 0.0, 3.0, "m", "amplitude with which the tube winds from side to side"},
    Parameter{"bend_length_m", 9.0, 2.0, 60.0, "m", "wavelength of the winding"},
    Parameter{"rock_count", 24, 0, 200, "1", "number of rocks on the ground, away from the path"},
    Parameter{"clear_half_width_m", 0.7, 0.2, 5.0, "m", "minimum distance of rocks from the x axis"},
};
constexpr std::array kTubeParameters = joined(kGroundParameters, kOwnTubeParameters);
constexpr Colour kRock = {0.42f, 0.36f, 0.33f, 1.0f};
constexpr double kOver_m = 0.5;  // overlap, so that there is no gap at the walls

double middle_m(const Values& values, double x_m) {
  return values.at("bend_m") * std::sin(2.0 * std::numbers::pi * x_m / values.at("bend_length_m"));
}

double ground_m(const Values& values, double x_m, double y_m) {
  const double u = (y_m - middle_m(values, x_m)) / values.at("half_width_m");
  return values.at("gutter_m") * u * u;
}

/// Adds the shell of the tube without contacts, because MuJoCo would use the convex hull of the shell for contacts. The
/// contacts with the ground and with the ends of the tube keep the robot inside the tube.
void add_shell(mjSpec* spec, engine::World& world, const Values& values, int side, const Relief& rough) {
  constexpr double kRing_m = 0.1;
  constexpr int kSteps = 28;
  constexpr double kBelow_rad = 0.25;  // the wall continues below ground
  const int rings = static_cast<int>(std::ceil(values.at("length_m") / kRing_m));
  std::vector<float> vertices;
  for (int ring = 0; ring <= rings; ++ring) {
    const double x_m = values.at("length_m") * (static_cast<double>(ring) / rings - 0.5);
    for (int step = 0; step <= kSteps; ++step) {
      const double angle = -kBelow_rad + (std::numbers::pi / 2 + kBelow_rad) * step / kSteps;
      // The roughness of the shell is a function of x and of the arc length from the top of the tube, where both halves
      // of the shell meet.
      const double arc_m = side * (std::numbers::pi / 2 - angle) * values.at("half_width_m");
      const double scale = 1.0 + rough.height_m(x_m, arc_m) / values.at("half_width_m");
      vertices.push_back(static_cast<float>(x_m));
      vertices.push_back(
          static_cast<float>(middle_m(values, x_m) + side * scale * values.at("half_width_m") * std::cos(angle)));
      vertices.push_back(static_cast<float>(values.at("gutter_m") +
                                            scale * (values.at("height_m") - values.at("gutter_m")) * std::sin(angle)));
    }
  }
  std::vector<int> faces;
  for (int ring = 0; ring < rings; ++ring) {
    for (int step = 0; step < kSteps; ++step) {
      const int here = ring * (kSteps + 1) + step, next = here + kSteps + 1;
      // The corners of each face are anticlockwise, seen from inside the tube, because pictures show only this side of
      // a face.
      const int first = side > 0 ? next : here + 1, second = side > 0 ? here + 1 : next;
      for (const int corner : {here, first, next + 1, here, next + 1, second}) faces.push_back(corner);
    }
  }
  const std::string name = side > 0 ? "shell_left" : "shell_right";
  mjsMesh* mesh = mjs_addMesh(spec, nullptr);
  mjs_setName(mesh->element, name.c_str());
  mesh->inertia = mjMESH_INERTIA_SHELL;  // an open mesh has no volume
  mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
  mjs_setInt(mesh->userface, faces.data(), static_cast<int>(faces.size()));
  mjsGeom* geom = add_surface(spec, world, name, mjGEOM_MESH, {0, 0, 0}, {0, 0, 0}, 0.0, kRock);
  mjs_setString(geom->meshname, name.c_str());
  geom->contype = 2;  // visible to lidars, untouched by robots
  geom->conaffinity = 0;
  if (side < 0) geom->group = kUnseenInPictures;  // cameras look from the right side
}

void add_ends(mjSpec* spec, engine::World& world, const Values& values, double half_y_m) {
  const double half_height_m = 0.75 * values.at("height_m"), x_m = values.at("length_m") / 2;
  for (const int sign : {1, -1}) {
    add_surface(spec, world, sign > 0 ? "end_front" : "end_back", mjGEOM_BOX, {sign * (x_m + 0.05), 0, half_height_m},
                {0.2, half_y_m, half_height_m}, 0.1, kRock);
  }
}

void add_rocks(mjSpec* spec, engine::World& world, const Values& values, Stream& stream) {
  const double half_m = values.at("length_m") / 2 - 0.5, clear_m = values.at("clear_half_width_m");
  for (int i = 0; i < static_cast<int>(values.at("rock_count")); ++i) {
    const double half_z_m = stream.uniform(0.06, 0.22), half_y_m = stream.uniform(0.08, 0.3);
    const Eigen::Vector3d size(stream.uniform(0.08, 0.3), half_y_m, half_z_m);
    const double x_m = stream.uniform(-half_m, half_m);
    const double side = stream.uniform() < 0.5 ? -1.0 : 1.0;
    const double widest_m = std::max(values.at("half_width_m"), clear_m + 0.4);
    const double y_m = side * (stream.uniform(clear_m, widest_m) + size.head<2>().maxCoeff());
    add_surface(spec, world, "rock_" + std::to_string(i), mjGEOM_ELLIPSOID,
                {x_m, y_m, ground_m(values, x_m, y_m) + 0.2 * size.z()}, size, stream.uniform(0.0, std::numbers::pi),
                {0.5f, 0.44f, 0.4f, 1.0f});
  }
}

void build_tube(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  Stream uneven(seed, "terrain.unevenness");
  const double half_x_m = values.at("length_m") / 2;
  const double half_y_m = values.at("half_width_m") + values.at("bend_m") + kOver_m;
  world.half_extent_m = std::max(half_x_m, half_y_m);
  add_ground(
      spec, world, values, half_x_m, half_y_m, [&](double x_m, double y_m) { return ground_m(values, x_m, y_m); },
      {0.38f, 0.34f, 0.32f, 1.0f}, uneven);
  const Relief rough(stream, {values.at("wall_roughness_m"), 0.3, 3.0});
  add_shell(spec, world, values, 1, rough);
  add_shell(spec, world, values, -1, rough);
  add_ends(spec, world, values, half_y_m);
  add_rocks(spec, world, values, stream);
  add_daylight(spec);
}

}  // namespace

const WorldType& tube_world() {
  static const WorldType kType{
      {"tube", "lava tube along x with rough ground that rises to the sides, a rough ceiling and rocks",
       kTubeParameters},
      build_tube};
  return kType;
}

}  // namespace tumble::sim
