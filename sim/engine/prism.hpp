// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

/// Geometry of one prism of ground and the axis of a strut, in any axes whose z is up.
namespace tumble::sim::engine {

/// What lies below a triangle, down to a level foot.
struct Prism {
  std::array<Eigen::Vector3d, 3> top_m;  ///< anticlockwise seen from above, none of the edges upright
  double foot_m;
};

/// The points of an axis and of a prism that are closest to each other.
struct Closest {
  double distance_m;
  Eigen::Vector3d axis_m, prism_m;
};

enum class Meeting { apart, near, pierced };

/// Whether the axis from `a_m` to `b_m` comes nearer to the prism than `reach_m`, and where; or whether it pierces the
/// prism, or all but touches it (10 um), when it has no closest points. Exact but for rounding: of two convex bodies
/// apart, an end of the axis is closest to the inside of a face, or the axis to an edge. The foot is taken to be out of
/// reach. Of several pairs of points at one distance, as for an axis along a face, it is one of them.
Meeting meet(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m, const Prism& prism, double reach_m,
             Closest& closest);

}  // namespace tumble::sim::engine
