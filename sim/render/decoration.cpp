// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/decoration.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

constexpr double kFieldGrid_m = 1.0, kFieldStep_m = 0.2, kPlaneGrid_m = 0.5, kPlaneHalf_m = 10.0;
constexpr double kLift_m = 0.012;  // height of lines above the surface, so that they stay visible
constexpr float kGridColour[4] = {0.12f, 0.14f, 0.10f, 0.30f};
constexpr double kGridPixels = 2.0;
constexpr std::size_t kManyPoints = 4000;

mjvGeom* next_geom(mjvScene& scene, int type, const float* rgba) {
  if (scene.ngeom >= scene.maxgeom) return nullptr;
  mjvGeom* geom = scene.geoms + scene.ngeom++;
  mjv_initGeom(geom, type, nullptr, nullptr, nullptr, rgba);
  geom->category = mjCAT_DECOR;
  return geom;
}

void add_line(mjvScene& scene, const Vector3d& from, const Vector3d& to) {
  if (mjvGeom* geom = next_geom(scene, mjGEOM_LINE, kGridColour)) {
    mjv_connector(geom, mjGEOM_LINE, kGridPixels, from.data(), to.data());
  }
}

Vector3d to_world(const mjData& data, int geom, const Vector3d& p_S) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WS(data.geom_xmat + 9 * geom);
  return Eigen::Map<const Vector3d>(data.geom_xpos + 3 * geom) + R_WS * p_S;
}

double field_height_m(const mjModel& model, int field, double x_m, double y_m) {
  const mjtNum* size = model.hfield_size + 4 * field;
  const int rows = model.hfield_nrow[field], columns = model.hfield_ncol[field];
  const double u = std::clamp((x_m / size[0] + 1.0) / 2.0, 0.0, 1.0) * (columns - 1);
  const double v = std::clamp((y_m / size[1] + 1.0) / 2.0, 0.0, 1.0) * (rows - 1);
  const int column = std::min(static_cast<int>(u), columns - 2), row = std::min(static_cast<int>(v), rows - 2);
  const float* data = model.hfield_data + model.hfield_adr[field] + row * columns + column;
  const double a = u - column, b = v - row;
  return size[2] *
         ((1 - b) * ((1 - a) * data[0] + a * data[1]) + b * ((1 - a) * data[columns] + a * data[columns + 1]));
}

template <typename Height, typename Line>
void drape(double half_x_m, double half_y_m, double grid_m, double step_m, const Height& height, const Line& line) {
  for (const int axis : {0, 1}) {
    const double across_m = axis == 0 ? half_y_m : half_x_m, along_m = axis == 0 ? half_x_m : half_y_m;
    const int lines = static_cast<int>(across_m / grid_m), steps = static_cast<int>(std::ceil(2.0 * along_m / step_m));
    for (int i = -lines; i <= lines; ++i) {
      const auto node = [&](int k) {
        const double along = -along_m + 2.0 * along_m * k / steps, across = i * grid_m;
        const double x = axis == 0 ? along : across, y = axis == 0 ? across : along;
        return Vector3d(x, y, height(x, y) + kLift_m);
      };
      for (int k = 0; k < steps; ++k) line(node(k), node(k + 1));
    }
  }
}

template <typename Line>
void each_grid_line(const engine::World& world, const Line& line) {
  const mjModel& model = *world.model;
  for (const int geom : world.surface_geom) {
    const mjtNum* size = model.geom_size + 3 * geom;
    if (model.geom_type[geom] == mjGEOM_HFIELD) {
      const int field = model.geom_dataid[geom];
      drape(
          model.hfield_size[4 * field], model.hfield_size[4 * field + 1], kFieldGrid_m, kFieldStep_m,
          [&](double x, double y) { return field_height_m(model, field, x, y); },
          [&](const Vector3d& from, const Vector3d& to) { line(geom, from, to); });
    } else if (model.geom_type[geom] == mjGEOM_PLANE) {
      const auto half = [](double s) { return s > 0.0 ? std::min(s, kPlaneHalf_m) : kPlaneHalf_m; };
      drape(
          half(size[0]), half(size[1]), kPlaneGrid_m, 2.0 * kPlaneHalf_m, [](double, double) { return 0.0; },
          [&](const Vector3d& from, const Vector3d& to) { line(geom, from, to); });
    }
  }
}

}  // namespace

int decoration_size(const engine::World& world, const View& view) {
  std::size_t count = 0;
  each_grid_line(world, [&](int, const Vector3d&, const Vector3d&) { ++count; });
  for (const DrawnPath& path : view.paths) count += path.points_W_m.size();
  for (const DrawnPoints& cloud : view.points) count += cloud.points_W_m.size();
  return static_cast<int>(count);
}

void add_grid(const engine::World& world, const mjData& data, mjvScene& scene) {
  each_grid_line(world, [&](int geom, const Vector3d& from, const Vector3d& to) {
    add_line(scene, to_world(data, geom, from), to_world(data, geom, to));
  });
}

void add_paths(const View& view, mjvScene& scene) {
  for (const DrawnPath& path : view.paths) {
    const Vector3d* from = nullptr;
    for (const Vector3d& to : path.points_W_m) {
      if (!to.allFinite()) {
        from = nullptr;  // the path has a gap
        continue;
      }
      if (from == nullptr) {
        from = &to;
        continue;
      }
      if ((to - *from).norm() < path.width_m && &to != &path.points_W_m.back()) continue;
      if (mjvGeom* geom = next_geom(scene, mjGEOM_CAPSULE, path.rgba.data())) {
        mjv_connector(geom, mjGEOM_CAPSULE, 0.5 * path.width_m, from->data(), to.data());
        geom->emission = 0.35f;  // keeps its colour in shade
        geom->specular = 0.0f;
      }
      from = &to;
    }
  }
}

void add_points(const View& view, mjvScene& scene) {
  for (const DrawnPoints& cloud : view.points) {
    const int type = cloud.points_W_m.size() > kManyPoints ? mjGEOM_BOX : mjGEOM_SPHERE;
    constexpr std::array<float, 4> kWhite = {1, 1, 1, 1};
    for (std::size_t i = 0; i < cloud.points_W_m.size(); ++i) {
      if (!cloud.points_W_m[i].allFinite()) continue;
      mjvGeom* geom = next_geom(scene, type, (i < cloud.rgba.size() ? cloud.rgba[i] : kWhite).data());
      if (geom == nullptr) return;
      for (int axis = 0; axis < 3; ++axis) {
        geom->size[axis] = static_cast<float>(cloud.radius_m);
        geom->pos[axis] = static_cast<float>(cloud.points_W_m[i][axis]);
      }
      geom->emission = 0.6f;
    }
  }
}

void add_legend(const View& view, const mjrRect& area, const mjrContext& context) {
  constexpr int kHeight = 44, kLetter = 17, kMargin = 12;  // pixels of the oversampled picture
  std::size_t letters = 0;
  for (const DrawnPath& path : view.paths) letters = std::max(letters, path.name.size());
  mjrRect label = {kMargin, area.height - kMargin, kLetter * static_cast<int>(letters + 2), kHeight};
  for (const DrawnPath& path : view.paths) {
    if (path.name.empty()) continue;
    label.bottom -= kHeight;
    const auto& [red, green, blue, opacity] = path.rgba;
    const float text = 0.3F * red + 0.6F * green + 0.1F * blue > 0.45F ? 0.0F : 1.0F;
    mjr_label(label, mjFONT_BIG, path.name.c_str(), red, green, blue, opacity, text, text, text, &context);
  }
}

}  // namespace tumble::sim
