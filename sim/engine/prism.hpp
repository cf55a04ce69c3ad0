// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

/// Geometry of one prism of ground and of a strut's axis, in any axes with z up.
namespace tumble::sim::engine {

/// A prism of ground: the volume below a triangle, down to a horizontal bottom.
struct Prism {
  std::array<Eigen::Vector3d, 3> top_m;  ///< anticlockwise seen from above; no edge is vertical
  double foot_m;
};

/// The closest points of an axis and of a prism.
struct Closest {
  double distance_m;
  Eigen::Vector3d axis_m, prism_m;
};

enum class Meeting { apart, near, pierced };

/// Finds the closest points if the axis from `a_m` to `b_m` is nearer to the prism than `reach_m`. If the axis pierces
/// the prism, or is within 10 um of the prism, the function reports no closest points. The closest points are exact
/// except for rounding: for two separate convex bodies, either an end of the axis is closest to the inside of a face,
/// or the axis is closest to an edge. The bottom of the prism is assumed to be out of reach. If several pairs of points
/// have equal distances, as for an axis along a face, one of these pairs is returned.
Meeting meet(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m, const Prism& prism, double reach_m,
             Closest& closest);

}  // namespace tumble::sim::engine
