// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

/// Triangles that share a vertex form a smooth surface. The corners of a triangle are anticlockwise, seen from outside.
struct MeshPart {
  std::array<float, 4> rgba = {1, 1, 1, 1};
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// If the part is a grid, `vertices_m` contains the grid nodes row by row. x increases along a row, and y increases
  /// from row to row. For a grid, `triangles` is empty, because each cell is two triangles, cut from (row, column) to
  /// (row + 1, column + 1).
  int rows = 0, columns = 0;
};

/// Returns the visible parts of the world in world axes, without the ceilings and near walls that would hide the
/// inside. A round part gets `segments` facets about its axis, and a capsule half this number.
std::vector<MeshPart> world_mesh(const BuiltSituation& built, int segments = 12);

std::vector<MeshPart> robot_mesh(const BuiltSituation& built, int segments = 20);

}  // namespace tumble::sim
