// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/lidar/shape.hpp"

namespace tumble::sim {

/// Triangles that share a vertex form one smooth surface; sharp edges have two vertices at one position.
struct Tessellation {
  std::vector<Eigen::Vector3f> vertices_F_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Converts a shape to triangles. Round shapes get `segments` facets about their axis (even, at least 4), with all
/// vertices on the shape. A plane becomes a rectangle; an infinite side gets the half width `unbounded_m`.
Tessellation tessellate(const Shape& shape, int segments, double unbounded_m);

}  // namespace tumble::sim
