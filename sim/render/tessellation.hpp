// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/lidar/shape.hpp"

namespace tumble::sim {

/// Triangles that share a vertex form one smooth surface. At a sharp edge, each position has two vertices.
struct Tessellation {
  std::vector<Eigen::Vector3f> vertices_F_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Converts a shape to triangles. A round shape gets `segments` facets about its axis, with all vertices on the shape;
/// `segments` must be even and at least 4. A plane becomes a rectangle. An infinite side of a plane gets the half width
/// `unbounded_m`.
Tessellation tessellate(const Shape& shape, int segments, double unbounded_m);

}  // namespace tumble::sim
