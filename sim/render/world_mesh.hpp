// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

/// A piece of a world or of a robot as triangles, for whoever draws it by other means than Renderer. Its triangles turn
/// to the left seen from outside; where they share a vertex the surface is smooth.
struct MeshPart {
  std::array<float, 4> rgba = {1, 1, 1, 1};
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Of a height field, and of a plane as one of a single cell: its nodes stand row by row in `vertices_m`, x grows
  /// along a row and y from row to row, and `triangles` is empty: each cell is two, cut from (row, column) to (row + 1,
  /// column + 1). 0 of all else.
  int rows = 0, columns = 0;
};

/// What pictures show of the world, in W: its surfaces and marks, without what hides an inside from their camera
/// (ceilings, a near wall). Round things have `segments` pieces about their axis, capsules half as many. Throws
/// InvalidSituation on a geom that has no surface.
std::vector<MeshPart> world_mesh(const BuiltSituation& built, int segments = 12);

/// What pictures show of the robot's body that carries the sensors, in B. Of a robot on joints (the pendulum) that is
/// its last segment. Empty without a robot.
std::vector<MeshPart> robot_mesh(const BuiltSituation& built, int segments = 20);

}  // namespace tumble::sim
