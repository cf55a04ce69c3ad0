// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/geoms.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::sim {

namespace {

mjsGeom* add_geom(mjSpec* spec, mjtGeom type, const Eigen::Vector3d& position_W_m, const Eigen::Vector3d& size_m,
                  double yaw_rad, const Colour& colour) {
  mjsGeom* geom = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  geom->type = type;
  for (int i = 0; i < 3; ++i) {
    geom->pos[i] = position_W_m[i];
    geom->size[i] = size_m[i];
  }
  geom->quat[0] = std::cos(yaw_rad / 2);
  geom->quat[3] = std::sin(yaw_rad / 2);
  std::copy(colour.begin(), colour.end(), geom->rgba);
  return geom;
}

}  // namespace

mjsGeom* add_surface(mjSpec* spec, engine::World& world, const std::string& name, mjtGeom type,
                     const Eigen::Vector3d& position_W_m, const Eigen::Vector3d& size_m, double yaw_rad,
                     const Colour& colour) {
  mjsGeom* geom = add_geom(spec, type, position_W_m, size_m, yaw_rad, colour);
  mjs_setName(geom->element, name.c_str());
  world.surfaces.push_back(name);
  return geom;
}

mjsGeom* add_height_field(mjSpec* spec, engine::World& world, const std::string& name, const HeightGrid& grid,
                          double common_position_m, double least_span_m, const Colour& colour) {
  const auto [low, high] = std::minmax_element(grid.heights_m.begin(), grid.heights_m.end());
  const double low_m = *low, span_m = std::max(*high - *low, least_span_m);
  std::vector<float> unit(grid.heights_m.size());
  std::transform(grid.heights_m.begin(), grid.heights_m.end(), unit.begin(),
                 [&](double h) { return static_cast<float>((h - low_m) / span_m); });
  mjsHField* field = mjs_addHField(spec);
  mjs_setName(field->element, name.c_str());
  field->nrow = grid.rows;
  field->ncol = grid.columns;
  field->size[0] = grid.half_x_m;
  field->size[1] = grid.half_y_m;
  field->size[2] = span_m;
  field->size[3] = common_position_m;
  mjs_setFloat(field->userdata, unit.data(), static_cast<int>(unit.size()));
  mjsGeom* geom = add_surface(spec, world, name, mjGEOM_HFIELD, {0, 0, low_m}, {0, 0, 0}, 0.0, colour);
  mjs_setString(geom->hfieldname, name.c_str());
  return geom;
}

void add_mark(mjSpec* spec, const engine::FrictionPatch& patch, const Colour& colour) {
  constexpr double kHalfThickness_m = 0.0005;
  mjsGeom* geom = add_geom(spec, mjGEOM_BOX, {patch.centre_x_m, patch.centre_y_m, kHalfThickness_m},
                           {patch.half_x_m, patch.half_y_m, kHalfThickness_m}, patch.yaw_rad, colour);
  geom->contype = 0;
  geom->conaffinity = 0;
  geom->group = 2;
}

void add_daylight(mjSpec* spec) {
  mjsLight* sun = mjs_addLight(mjs_findBody(spec, "world"), nullptr);
  sun->type = mjLIGHT_DIRECTIONAL;
  const double from[3] = {0, 0, 30}, direction[3] = {0.4, 0.3, -0.86};
  std::copy(from, from + 3, sun->pos);
  std::copy(direction, direction + 3, sun->dir);
  std::fill(sun->diffuse, sun->diffuse + 3, 0.7f);
  std::fill(sun->ambient, sun->ambient + 3, 0.25f);

  mjsTexture* sky = mjs_addTexture(spec, nullptr);
  mjs_setName(sky->element, "sky");
  sky->type = mjTEXTURE_SKYBOX;
  sky->builtin = mjBUILTIN_GRADIENT;
  const double high[3] = {0.45, 0.62, 0.85}, low[3] = {0.9, 0.93, 0.96};
  std::copy(high, high + 3, sky->rgb1);
  std::copy(low, low + 3, sky->rgb2);
  sky->width = 64;
  sky->height = 384;
}

}  // namespace tumble::sim
