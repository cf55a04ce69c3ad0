// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

enum class PathShape {
  line,   ///< straight along +x, with an optional lateral sway
  l,      ///< two equal legs with a corner to the left
  eight,  ///< two equal loops; start and end are their crossing
  free,   ///< a smooth random path
};
inline constexpr int kPathShapes = 4;

struct PathPlan {
  PathShape shape = PathShape::line;
  double length_m = 1.0;     ///< length along the path; for a line, without its sway
  double heading_rad = 0.0;  ///< rotation of the path about the vertical
  /// Line only: amplitude of the lateral sway, which fades over the first and last half metre
  double sway_m = 0.0;
  double sway_length_m = 4.0;  ///< line only: wavelength of the lateral sway
};

/// Only the free path draws random numbers from `stream`.
std::vector<Eigen::Vector2d> plan_path(const PathPlan& plan, Stream& stream);

}  // namespace tumble::sim
