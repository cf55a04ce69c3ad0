// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/shape.hpp"

/// shape_lanes.hpp intersects eight rays with one shape at a time.
namespace tumble::sim {

/// kShapeLanes is the number of rays that Embree passes in one call.
inline constexpr int kShapeLanes = 8;

/// ShapeHits contains the hits of eight rays on a shape, as computed by cast_ray().
struct ShapeHits {
  alignas(64) double range_m[kShapeLanes];  ///< infinity without a hit
  /// Unit normal of the surface in F; undefined without a hit. Zero components of the normal may have either sign.
  alignas(64) double normal_x[kShapeLanes], normal_y[kShapeLanes], normal_z[kShapeLanes];
};

/// ShapeRays contains eight rays in the frame F, stored by coordinate.
struct ShapeRays {
  const float *origin_x_m, *origin_y_m, *origin_z_m;
  const float *direction_x, *direction_y, *direction_z;  ///< unit vectors
};

/// Computes the result of cast_ray() for eight rays, bit-identically. Planes and boxes (walls of rooms) are computed
/// for all rays at once. The hit of a ray is undefined if its entry of `wanted` is 0.
void cast_rays(const Shape& shape, const ShapeRays& rays, const int* wanted, ShapeHits& hits);

}  // namespace tumble::sim
