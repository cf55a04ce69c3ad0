// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/tessellation.hpp"

#include <cmath>
#include <numbers>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

struct Ring {
  double radius_x_m, radius_y_m, z_m;
};

std::uint32_t add_ring(const Shape& shape, const Ring& ring, int segments, Tessellation& out) {
  const auto first = static_cast<std::uint32_t>(out.vertices_F_m.size());
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    const Vector3d p_S(ring.radius_x_m * std::cos(angle), ring.radius_y_m * std::sin(angle), ring.z_m);
    out.vertices_F_m.push_back((shape.R_FS * p_S + shape.p_FS_m).cast<float>());
    if (ring.radius_x_m == 0.0) break;
  }
  return first;
}

void add_band(std::uint32_t low, bool low_is_pole, std::uint32_t high, bool high_is_pole, int segments,
              Tessellation& out) {
  const auto count = static_cast<std::uint32_t>(segments);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    if (!low_is_pole) out.triangles.push_back({low + i, low + next, high_is_pole ? high : high + next});
    if (!high_is_pole) out.triangles.push_back({low_is_pole ? low : low + i, high + next, high + i});
  }
}

void add_round(const Shape& shape, const std::vector<Ring>& rings, int segments, Tessellation& out) {
  std::uint32_t below = add_ring(shape, rings.front(), segments, out);
  for (std::size_t k = 1; k < rings.size(); ++k) {
    const std::uint32_t here = add_ring(shape, rings[k], segments, out);
    add_band(below, rings[k - 1].radius_x_m == 0.0, here, rings[k].radius_x_m == 0.0, segments, out);
    below = here;
  }
}

void add_ellipsoid(const Shape& shape, const Vector3d& semi_m, double half_m, int segments, Tessellation& out) {
  const int steps = segments / 2;
  std::vector<Ring> rings;
  for (int k = 0; k <= steps; ++k) {
    const double latitude = std::numbers::pi * (static_cast<double>(k) / steps - 0.5);
    const bool pole = k == 0 || k == steps;
    const double across = pole ? 0.0 : std::cos(latitude), z_m = semi_m.z() * std::sin(latitude);
    const bool equator = 2 * k == steps;
    if (equator && half_m > 0.0) rings.push_back({semi_m.x(), semi_m.y(), -half_m});
    const double shift_m = 2 * k < steps ? -half_m : half_m;
    rings.push_back({across * semi_m.x(), across * semi_m.y(), z_m + shift_m});
  }
  add_round(shape, rings, segments, out);
}

void add_cylinder(const Shape& shape, double radius_m, double half_m, int segments, Tessellation& out) {
  const Ring low{radius_m, radius_m, -half_m}, high{radius_m, radius_m, half_m};
  add_round(shape, {low, high}, segments, out);
  add_round(shape, {{0.0, 0.0, -half_m}, low}, segments, out);
  add_round(shape, {high, {0.0, 0.0, half_m}}, segments, out);
}

void add_face(const Shape& shape, const std::array<Vector3d, 4>& corners_S_m, Tessellation& out) {
  const auto first = static_cast<std::uint32_t>(out.vertices_F_m.size());
  for (const Vector3d& corner : corners_S_m)
    out.vertices_F_m.push_back((shape.R_FS * corner + shape.p_FS_m).cast<float>());
  out.triangles.push_back({first, first + 1, first + 2});
  out.triangles.push_back({first, first + 2, first + 3});
}

void add_box(const Shape& shape, const Vector3d& half_m, Tessellation& out) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vector3d n = Vector3d::Zero(), u = Vector3d::Zero(), v = Vector3d::Zero();
      n[axis] = side * half_m[axis];
      u[(axis + 1) % 3] = half_m[(axis + 1) % 3];
      v[(axis + 2) % 3] = side * half_m[(axis + 2) % 3];
      add_face(shape, {n - u - v, n + u - v, n + u + v, n - u + v}, out);
    }
  }
}

}  // namespace

Tessellation tessellate(const Shape& shape, int segments, double unbounded_m) {
  Tessellation out;
  const Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::plane: {
      const double x = size.x() > 0.0 ? size.x() : unbounded_m, y = size.y() > 0.0 ? size.y() : unbounded_m;
      add_face(shape, {Vector3d(-x, -y, 0), Vector3d(x, -y, 0), Vector3d(x, y, 0), Vector3d(-x, y, 0)}, out);
      break;
    }
    case ShapeKind::sphere:
      add_ellipsoid(shape, Vector3d::Constant(size.x()), 0.0, segments, out);
      break;
    case ShapeKind::capsule:
      add_ellipsoid(shape, Vector3d::Constant(size.x()), size.y(), segments, out);
      break;
    case ShapeKind::ellipsoid:
      add_ellipsoid(shape, size, 0.0, segments, out);
      break;
    case ShapeKind::cylinder:
      add_cylinder(shape, size.x(), size.y(), segments, out);
      break;
    case ShapeKind::box:
      add_box(shape, size, out);
      break;
  }
  return out;
}

}  // namespace tumble::sim
