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

mjsGeom* add_field(mjSpec* spec, engine::World& world, const Grid& grid, const std::vector<double>& heights_m,
                   const Colour& colour) {
  const auto [low, high] = std::minmax_element(heights_m.begin(), heights_m.end());
  const double low_m = *low, span_m = std::max(*high - *low, 1e-6);
  std::vector<float> unit(heights_m.size());
  std::transform(heights_m.begin(), heights_m.end(), unit.begin(),
                 [&](double h) { return static_cast<float>((h - low_m) / span_m); });
  mjsHField* field = mjs_addHField(spec);
  mjs_setName(field->element, "floor");
  field->nrow = grid.rows;
  field->ncol = grid.columns;
  field->size[0] = grid.half_x_m;
  field->size[1] = grid.half_y_m;
  field->size[2] = span_m;
  field->size[3] = kBase_m;
  mjs_setFloat(field->userdata, unit.data(), static_cast<int>(unit.size()));
  mjsGeom* geom = add_surface(spec, world, "floor", mjGEOM_HFIELD, {0, 0, low_m}, {0, 0, 0}, 0.0, colour);
  mjs_setString(geom->hfieldname, "floor");
  return geom;
}

}  // namespace

void set_ground_contact(mjsGeom* geom, const Values& values) {
  const double soft_s = values.at("soft_time_s");
  geom->condim = 4;
  geom->friction[0] = values.at("friction");
  geom->friction[1] = values.at("spin_friction_m");
  // the weight of the mixture: none for the ground, or one beside which the robot's one does not count
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
  set_ground_contact(add_field(spec, world, grid, heights_m, colour), values);
  return true;
}

}  // namespace tumble::sim
