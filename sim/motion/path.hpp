// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Shapes of a level path, by the number that a scenario gives.
enum class PathShape {
  line,   ///< straight, along +x; it may sway from side to side
  l,      ///< two equal legs with a corner to the left
  eight,  ///< two equal loops through the start, which is also the end
  free,   ///< a smooth random path
};
inline constexpr int kPathShapes = 4;

struct PathPlan {
  PathShape shape = PathShape::line;
  double length_m = 1.0;       ///< of the line without its sway, of the others along the path
  double heading_rad = 0.0;    ///< turn of the whole about the vertical
  double sway_m = 0.0;         ///< of the line: amplitude, fading over its first and last half metre
  double sway_length_m = 4.0;  ///< of the line: wavelength
};

/// Nodes of the path, about 5 mm apart, the middle of their bounding box at the origin. The free one draws its bends
/// from `stream`; the others take nothing from it. O(length).
std::vector<Eigen::Vector2d> plan_path(const PathPlan& plan, Stream& stream);

}  // namespace tumble::sim
