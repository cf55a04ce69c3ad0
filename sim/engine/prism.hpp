// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble::sim::engine {

struct Prism {
  std::array<Eigen::Vector3d, 3> top_m;  ///< anticlockwise from above, never vertical
  double foot_m;
};

struct Closest {
  double distance_m;
  Eigen::Vector3d axis_m, prism_m;
};

enum class Meeting { apart, near, pierced };

/// Finds the closest points of a prism and of the axis from `a_m` to `b_m`. The result is empty if the axis intersects
/// the prism, or if the distance is below 10 um.
Meeting meet(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m, const Prism& prism, double reach_m,
             Closest& closest);

}  // namespace tumble::sim::engine
