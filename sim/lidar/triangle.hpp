// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tumble::sim {

/// Returns the distance from a point to a triangle with its interior [m]; for a degenerate triangle, to its edges.
float triangle_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                        const Eigen::Vector3f& point);

}  // namespace tumble::sim
