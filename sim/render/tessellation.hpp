// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/lidar/shape.hpp"

/// Private to sim: primitives as triangles.
namespace tumble::sim {

/// Triangles turn to the left seen from outside. What shares a vertex is one smooth surface; edges have two vertices at
/// one place.
struct Tessellation {
  std::vector<Eigen::Vector3f> vertices_F_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The surface of a primitive in F; round ones of `segments` pieces about their axis (even, 4 at least), inscribed: no
/// vertex lies outside. A plane is its rectangle, half `unbounded_m` wide where it has no bound.
Tessellation tessellate(const Shape& shape, int segments, double unbounded_m);

}  // namespace tumble::sim
