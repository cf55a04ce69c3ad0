// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/shape.hpp"

namespace tumble::sim {

inline constexpr int kShapeLanes = 8;

struct ShapeHits {
  alignas(64) double range_m[kShapeLanes];  ///< infinity without a hit
  alignas(64) double normal_x[kShapeLanes], normal_y[kShapeLanes], normal_z[kShapeLanes];
};

struct ShapeRays {
  const float *origin_x_m, *origin_y_m, *origin_z_m;
  const float *direction_x, *direction_y, *direction_z;  ///< unit vectors
};

void cast_rays(const Shape& shape, const ShapeRays& rays, const int* wanted, ShapeHits& hits);

}  // namespace tumble::sim
