// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

enum class PathShape {
  line,   ///< along +x, optionally with sway
  l,      ///< two equal legs, left corner
  eight,  ///< start and end at the crossing
  free,   ///< a smooth random path
};
inline constexpr int kPathShapes = 4;

struct PathPlan {
  PathShape shape = PathShape::line;
  double length_m = 1.0;  ///< without the sway of a line
  double heading_rad = 0.0;
  /// only for the path `line`: amplitude of the lateral sway, which fades over the first and last half metre
  double sway_m = 0.0;
  double sway_length_m = 4.0;
};

std::vector<Eigen::Vector2d> plan_path(const PathPlan& plan, Stream& stream);

}  // namespace tumble::sim
