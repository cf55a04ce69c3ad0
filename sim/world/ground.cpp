// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/ground.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/world/terrain/relief.hpp"

namespace tumble::sim {

namespace {

constexpr double kCell_m = 0.05;
constexpr double kBase_m = 0.5;
constexpr double kLeastSpan_m = 1e-6;

struct Grid {
  int rows, columns;  ///< along y, along x
  double half_x_m, half_y_m;
  double x_m(int column) const { return 2.0 * half_x_m / (columns - 1) * column - half_x_m; }
  double y_m(int row) const { return 2.0 * half_y_m / (rows - 1) * row - half_y_m; }
};

std::vector<double> unevenness_m(const Grid& grid, const Values& values, Stream& stream) {
  std::vector<double> heights_m(static_cast<std::size_t>(grid.rows) * grid.columns, 0.0);
  if (values.at("roughness_m") <= 0.0) return heights_m;
  const double shortest_m = values.at("roughness_shortest_m");
  const Relief unevenness(
      stream, {values.at("roughness_m"), shortest_m, std::max(values.at("roughness_longest_m"), shortest_m)});
  std::size_t i = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      heights_m[i++] = unevenness.height_m(grid.x_m(column), grid.y_m(row));
  }
  const double highest_m = *std::max_element(heights_m.begin(), heights_m.end());
  for (double& height_m : heights_m) height_m -= highest_m;
  return heights_m;
}

}  // namespace

void set_ground_contact(mjsGeom* geom, const Values& values) {
  const double soft_s = values.at("soft_time_s");
  geom->condim = 4;
  geom->friction[0] = values.at("friction");
  geom->friction[1] = values.at("spin_friction_m");
  geom->solmix = soft_s > 0.0 ? 1e6 : 0.0;
  if (soft_s <= 0.0) return;
  geom->solref[0] = soft_s;
  geom->solref[1] = values.at("soft_damping_ratio");
}

bool add_ground(mjSpec* spec, engine::World& world, const Values& values, double half_x_m, double half_y_m,
                const std::function<double(double, double)>& profile_m, const Colour& colour, Stream& stream) {
  if (!profile_m && values.at("roughness_m") <= 0.0) {
    set_ground_contact(
        add_surface(spec, world, "floor", mjGEOM_PLANE, {0, 0, 0}, {half_x_m, half_y_m, 1.0}, 0.0, colour), values);
    return false;
  }
  const auto nodes = [](double half_m) { return static_cast<int>(std::ceil(2.0 * half_m / kCell_m)) + 1; };
  const Grid grid{nodes(half_y_m), nodes(half_x_m), half_x_m, half_y_m};
  std::vector<double> heights_m = unevenness_m(grid, values, stream);
  if (profile_m) {
    std::size_t i = 0;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column)
        heights_m[i++] += profile_m(grid.x_m(column), grid.y_m(row));
    }
  }
  mjsGeom* field = add_height_field(spec, world, "floor", {grid.rows, grid.columns, half_x_m, half_y_m, heights_m},
                                    kBase_m, kLeastSpan_m, colour);
  set_ground_contact(field, values);
  return true;
}

}  // namespace tumble::sim
