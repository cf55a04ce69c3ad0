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

/// Eight rays in F, a coordinate at a time: `ray[0]` to `ray[2]` are the origins [m], `ray[3]` to `ray[5]` the unit
/// directions.
using ShapeRays = float[6][kShapeLanes];

/// cast_ray() of eight rays, to the last bit. Planes and boxes, of which rooms are made, are met by all at once.
void cast_rays(const Shape& shape, const ShapeRays& rays, ShapeHits& hits);

}  // namespace tumble::sim
