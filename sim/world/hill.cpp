// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/random/stream.hpp"
#include "sim/world/geoms.hpp"
#include "sim/world/relief.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"slope_rad", 0.6, 0.1, 1.2, "rad", "steepness of the slope between top and run-out"},
    Parameter{"slope_length_m", 6.0, 1.0, 20.0, "m", "horizontal length of the slope"},
    Parameter{"relief_m", 0.12, 0.0, 1.0, "m", "root mean square of the undulation, 2.5 to 9 m long; 0: none"},
    Parameter{"bump_height_m", 0.2, 0.0, 0.6, "m", "largest bump or hollow, 0.5 to 1.6 m wide; 0: none"},
    Parameter{"bump_count", 500, 0, 5000, "1", "bumps and hollows on the 1600 m^2"},
    Parameter{"rock_count", 40, 0, 200, "1", "rocks, half buried ellipsoids"},
    Parameter{"rock_size_m", 0.3, 0.05, 1.5, "m", "largest half axis of a rock; the others are drawn below it"},
    Parameter{"trunk_count", 40, 0, 200, "1", "tree trunks, upright cylinders"},
    Parameter{"trunk_radius_m", 0.15, 0.03, 0.6, "m", "largest radius of a trunk"},
    Parameter{"clear_half_width_m", 2.5, 0.0, 15.0, "m", "no trunk stands within this distance of the fall line"},
    Parameter{"buildings", 1, 0, 1, "1", "1: a building below and a wall beside the slope, out of reach"},
};

constexpr double kHalfExtent_m = 20.0;
constexpr double kCell_m = 0.1;
constexpr int kSide = 401;
constexpr double kEdge_m = -8.0;      // x of the upper edge of the slope
constexpr double kSetBack_m = 0.8;    // the robot starts this far behind the edge
constexpr double kRounding_m = 0.25;  // of the edges above and below the slope

/// Height of the bare profile, 0 on the flat top: two smooth corners (softplus), falling along +x.
double profile_m(double x_m, double slope_rad, double length_m) {
  const auto ramp = [](double u) {
    return kRounding_m * (u > 8 * kRounding_m ? u / kRounding_m : std::log1p(std::exp(u / kRounding_m)));
  };
  return -std::tan(slope_rad) * (ramp(x_m - kEdge_m) - ramp(x_m - kEdge_m - length_m));
}

/// 0 where the robot stands at the start, 1 away from it: relief fades there so that it can rest.
double fade(double distance_m) {
  const double u = std::clamp((distance_m - 0.6) / 1.2, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

class Ground {
 public:
  Ground(const Values& values, Stream& stream) : heights_m_(static_cast<std::size_t>(kSide) * kSide) {
    const Undulation undulation(stream, values.at("relief_m"), 2.5, 9.0);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) at(row, column) = undulation.height_m(x_m(column), x_m(row));
    }
    Bumps(stream, static_cast<int>(values.at("bump_count")), values.at("bump_height_m"), kHalfExtent_m)
        .add_to(heights_m_, kSide, kCell_m);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        at(row, column) *= fade(std::hypot(x_m(column) - (kEdge_m - kSetBack_m), x_m(row)));
        at(row, column) += profile_m(x_m(column), values.at("slope_rad"), values.at("slope_length_m"));
      }
    }
  }

  /// Height at the nearest node.
  double height_m(double x_at_m, double y_at_m) const { return heights_m_[index(y_at_m) * kSide + index(x_at_m)]; }

  void add_to(mjSpec* spec, engine::World& world) const {
    const auto [low, high] = std::minmax_element(heights_m_.begin(), heights_m_.end());
    const double span_m = std::max(*high - *low, 1e-3);
    std::vector<float> unit(heights_m_.size());
    std::transform(heights_m_.begin(), heights_m_.end(), unit.begin(),
                   [&](double h) { return static_cast<float>((h - *low) / span_m); });
    mjsHField* field = mjs_addHField(spec);
    mjs_setName(field->element, "terrain");
    field->nrow = kSide;
    field->ncol = kSide;
    field->size[0] = field->size[1] = kHalfExtent_m;
    field->size[2] = span_m;
    field->size[3] = 1.0;
    mjs_setFloat(field->userdata, unit.data(), static_cast<int>(unit.size()));
    mjsGeom* geom =
        add_surface(spec, world, "terrain", mjGEOM_HFIELD, {0, 0, *low}, {0, 0, 0}, 0.0, {0.42f, 0.52f, 0.28f, 1.0f});
    mjs_setString(geom->hfieldname, "terrain");
  }

 private:
  static double x_m(int column) { return column * kCell_m - kHalfExtent_m; }
  static std::size_t index(double at_m) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(std::lround((at_m + kHalfExtent_m) / kCell_m)), 0, kSide - 1));
  }
  double& at(int row, int column) { return heights_m_[static_cast<std::size_t>(row) * kSide + column]; }

  std::vector<double> heights_m_;
};

void add_rocks(mjSpec* spec, engine::World& world, const Values& values, const Ground& ground, Stream& stream) {
  const double largest_m = values.at("rock_size_m");
  for (int i = 0; i < static_cast<int>(values.at("rock_count")); ++i) {
    Eigen::Vector2d at;
    do {
      at = {stream.uniform(-18.0, 18.0), stream.uniform(-18.0, 18.0)};
    } while ((at - world.start_W_m.head<2>()).norm() < 1.8);
    const Eigen::Vector3d size(stream.uniform(0.4, 1.0) * largest_m, stream.uniform(0.4, 1.0) * largest_m,
                               stream.uniform(0.3, 0.7) * largest_m);
    add_surface(spec, world, "rock_" + std::to_string(i), mjGEOM_ELLIPSOID,
                {at.x(), at.y(), ground.height_m(at.x(), at.y()) + 0.2 * size.z()}, size,
                stream.uniform(0.0, std::numbers::pi), {0.5f, 0.48f, 0.45f, 1.0f});
  }
}

void add_trunks(mjSpec* spec, engine::World& world, const Values& values, const Ground& ground, Stream& stream) {
  const double clear_m = values.at("clear_half_width_m");
  for (int i = 0; i < static_cast<int>(values.at("trunk_count")); ++i) {
    const double x = stream.uniform(-18.0, 18.0);
    const double side = stream.uniform() < 0.5 ? -1.0 : 1.0;
    const double y = side * stream.uniform(clear_m, 18.0);
    const double half_height_m = stream.uniform(1.5, 3.0);
    const double radius_m = stream.uniform(0.4, 1.0) * values.at("trunk_radius_m");
    constexpr double kBuried_m = 0.5;
    add_surface(spec, world, "trunk_" + std::to_string(i), mjGEOM_CYLINDER,
                {x, y, ground.height_m(x, y) + half_height_m - kBuried_m}, {radius_m, half_height_m, 0.0}, 0.0,
                {0.36f, 0.26f, 0.17f, 1.0f});
  }
}

void add_buildings(mjSpec* spec, engine::World& world, const Ground& ground) {
  constexpr double kBuried_m = 1.0;
  add_surface(spec, world, "building", mjGEOM_BOX, {15.5, -9.0, ground.height_m(15.5, -9.0) + 2.5 - kBuried_m},
              {2.0, 4.0, 2.5}, 0.2, {0.8f, 0.76f, 0.68f, 1.0f});
  add_surface(spec, world, "wall", mjGEOM_BOX, {2.0, 17.0, ground.height_m(2.0, 17.0) + 1.5 - kBuried_m},
              {7.0, 0.15, 2.5}, -0.1, {0.66f, 0.62f, 0.58f, 1.0f});
}

void build(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Stream stream(seed, "terrain");
  const Ground ground(values, stream);
  world.half_extent_m = kHalfExtent_m;
  world.start_W_m = {kEdge_m - kSetBack_m, 0.0, ground.height_m(kEdge_m - kSetBack_m, 0.0)};
  ground.add_to(spec, world);
  add_rocks(spec, world, values, ground, stream);
  add_trunks(spec, world, values, ground, stream);
  if (values.at("buildings") > 0.5) add_buildings(spec, world, ground);
  add_daylight(spec);
}

}  // namespace

const WorldType& hill_world() {
  static const WorldType kType{
      {"hill", "grassy hill of 40 by 40 m: flat top, slope along +x, run-out, relief, rocks, trunks", kParameters},
      build};
  return kType;
}

}  // namespace tumble::sim
