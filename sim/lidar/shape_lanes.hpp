// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/shape.hpp"

/// Private to sim: eight rays against one shape at a time.
namespace tumble::sim {

/// Rays that Embree hands over at once.
inline constexpr int kShapeLanes = 8;

/// Where eight rays meet a shape: what cast_ray() says of each.
struct ShapeHits {
  alignas(64) double range_m[kShapeLanes];  ///< infinity where there is none
  /// Of the surface there, unit, in F; without meaning where there is no hit. Zeros may bear the other sign.
  alignas(64) double normal_x[kShapeLanes], normal_y[kShapeLanes], normal_z[kShapeLanes];
};

/// Eight rays in F, a coordinate at a time.
struct ShapeRays {
  const float *origin_x_m, *origin_y_m, *origin_z_m;
  const float *direction_x, *direction_y, *direction_z;  ///< unit
};

/// cast_ray() of eight rays, to the last bit. Planes and boxes, of which rooms are made, are met by all at once. Hits
/// of rays that are not `wanted` (0) have no meaning.
void cast_rays(const Shape& shape, const ShapeRays& rays, const int* wanted, ShapeHits& hits);

}  // namespace tumble::sim
