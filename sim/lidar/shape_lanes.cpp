// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/shape_lanes.hpp"

#include <cmath>
#include <limits>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

struct LocalRays {
  alignas(64) double origin[3][kShapeLanes], direction[3][kShapeLanes];
};

[[gnu::target("avx2")]] void to_shape_axes(const Shape& shape, const ShapeRays& rays, LocalRays& local) {
  const double px = shape.p_FS_m.x(), py = shape.p_FS_m.y(), pz = shape.p_FS_m.z();
  for (int axis = 0; axis < 3; ++axis) {
    // The operations have the same order as Eigen's operations, so that the results are bit-identical.
    const double x = shape.R_FS(0, axis), y = shape.R_FS(1, axis), z = shape.R_FS(2, axis);
    for (int i = 0; i < kShapeLanes; ++i) {
      local.origin[axis][i] =
          x * (rays.origin_x_m[i] - px) + y * (rays.origin_y_m[i] - py) + z * (rays.origin_z_m[i] - pz);
      local.direction[axis][i] = x * rays.direction_x[i] + y * rays.direction_y[i] + z * rays.direction_z[i];
    }
  }
}

[[gnu::target("avx2")]] void cast_on_plane(const Shape& shape, const LocalRays& rays, ShapeHits& hits) {
  const double half_x = shape.size_m.x() > 0.0 ? shape.size_m.x() : kUnbounded;
  const double half_y = shape.size_m.y() > 0.0 ? shape.size_m.y() : kUnbounded;
  const double normal_x = shape.R_FS(0, 2), normal_y = shape.R_FS(1, 2), normal_z = shape.R_FS(2, 2);
  for (int i = 0; i < kShapeLanes; ++i) {
    const double x = -rays.origin[2][i] / rays.direction[2][i];
    const bool ahead = rays.direction[2][i] < 0.0 && x >= 0.0;
    const bool within = std::abs(rays.origin[0][i] + x * rays.direction[0][i]) <= half_x &&
                        std::abs(rays.origin[1][i] + x * rays.direction[1][i]) <= half_y;
    hits.range_m[i] = ahead && within ? x : kUnbounded;
    hits.normal_x[i] = normal_x;
    hits.normal_y[i] = normal_y;
    hits.normal_z[i] = normal_z;
  }
}

/// Computes hits on a box by the slab method (Kay and Kajiya, SIGGRAPH 1986). A ray from outside hits the box where the
/// ray enters the last slab. A ray from inside hits the box where the ray leaves the first slab.
[[gnu::target("avx2")]] void cast_on_box(const Shape& shape, const LocalRays& rays, ShapeHits& hits) {
  alignas(64) double enter[kShapeLanes], enter_axis[kShapeLanes], enter_sign[kShapeLanes];
  alignas(64) double leave[kShapeLanes], leave_axis[kShapeLanes], leave_sign[kShapeLanes], misses[kShapeLanes];
  for (int i = 0; i < kShapeLanes; ++i) {
    enter[i] = -kUnbounded;
    leave[i] = kUnbounded;
    enter_axis[i] = enter_sign[i] = leave_axis[i] = leave_sign[i] = misses[i] = 0.0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double half = shape.size_m[axis], number = axis;
    const double *o = rays.origin[axis], *d = rays.direction[axis];
    for (int i = 0; i < kShapeLanes; ++i) {
      const bool along = d[i] == 0.0;
      const double low = (-half - o[i]) / d[i], high = (half - o[i]) / d[i];
      const double near = along ? -kUnbounded : low > high ? high : low;
      const double far = along ? kUnbounded : low > high ? low : high;
      const double beside = std::abs(o[i]) > half ? 1.0 : 0.0;
      misses[i] = along ? misses[i] + beside : misses[i];
      const double towards = d[i] > 0.0 ? -1.0 : 1.0;
      enter_axis[i] = near > enter[i] ? number : enter_axis[i];
      enter_sign[i] = near > enter[i] ? towards : enter_sign[i];
      enter[i] = near > enter[i] ? near : enter[i];
      leave_axis[i] = far < leave[i] ? number : leave_axis[i];
      leave_sign[i] = far < leave[i] ? -towards : leave_sign[i];
      leave[i] = far < leave[i] ? far : leave[i];
    }
  }
  for (int i = 0; i < kShapeLanes; ++i) {
    hits.range_m[i] = enter[i] >= 0.0 ? enter[i] : leave[i];
    hits.range_m[i] = enter[i] > leave[i] || leave[i] < 0.0 || misses[i] != 0.0 ? kUnbounded : hits.range_m[i];
    enter_axis[i] = enter[i] >= 0.0 ? enter_axis[i] : leave_axis[i];
    enter_sign[i] = enter[i] >= 0.0 ? enter_sign[i] : leave_sign[i];
  }
  double* const normal[3] = {hits.normal_x, hits.normal_y, hits.normal_z};
  for (int row = 0; row < 3; ++row) {
    const double x = shape.R_FS(row, 0), y = shape.R_FS(row, 1), z = shape.R_FS(row, 2);
    double* const to = normal[row];
    for (int i = 0; i < kShapeLanes; ++i) {
      to[i] = enter_sign[i] * (enter_axis[i] == 0.0 ? x : enter_axis[i] == 1.0 ? y : z);
    }
  }
}

void cast_one_by_one(const Shape& shape, const ShapeRays& rays, const int* wanted, ShapeHits& hits) {
  for (int i = 0; i < kShapeLanes; ++i) {
    if (wanted[i] == 0) continue;
    const Vector3d origin(rays.origin_x_m[i], rays.origin_y_m[i], rays.origin_z_m[i]);
    const Vector3d direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
    Vector3d normal = Vector3d::Zero();
    hits.range_m[i] = cast_ray(shape, origin, direction, normal);
    hits.normal_x[i] = normal.x();
    hits.normal_y[i] = normal.y();
    hits.normal_z[i] = normal.z();
  }
}

}  // namespace

void cast_rays(const Shape& shape, const ShapeRays& rays, const int* wanted, ShapeHits& hits) {
  if (shape.kind != ShapeKind::plane && shape.kind != ShapeKind::box) {
    cast_one_by_one(shape, rays, wanted, hits);
    return;
  }
  LocalRays local;
  to_shape_axes(shape, rays, local);
  if (shape.kind == ShapeKind::plane)
    cast_on_plane(shape, local, hits);
  else
    cast_on_box(shape, local, hits);
}

}  // namespace tumble::sim
