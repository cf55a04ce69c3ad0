// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

double squared_distance_to_segment(const Vector3d& edge, const Vector3d& from_start) {
  const double length2 = edge.squaredNorm();
  const double along = length2 > 0.0 ? std::clamp(edge.dot(from_start) / length2, 0.0, 1.0) : 0.0;
  return (from_start - along * edge).squaredNorm();
}

}  // namespace

float triangle_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                        const Eigen::Vector3f& point) {
  const Vector3d ab = (b - a).cast<double>(), ac = (c - a).cast<double>(), ap = (point - a).cast<double>();
  const Vector3d normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (area2 > 0.0) {
    const double weight_c = ab.cross(ap).dot(normal), weight_b = ap.cross(ac).dot(normal);
    if (weight_b >= 0.0 && weight_c >= 0.0 && weight_b + weight_c <= area2) {
      return static_cast<float>(std::abs(ap.dot(normal)) / std::sqrt(area2));
    }
  }
  const double nearest2 = std::min({squared_distance_to_segment(ab, ap), squared_distance_to_segment(ac, ap),
                                    squared_distance_to_segment(ac - ab, ap - ab)});
  return static_cast<float>(std::sqrt(nearest2));
}

}  // namespace tumble::sim
