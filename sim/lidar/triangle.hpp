// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tumble::sim {

/// Returns the distance from a point to a triangle, including its interior [m]. If the triangle is degenerate, the
/// result is the distance to the edges.
float triangle_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                        const Eigen::Vector3f& point);

}  // namespace tumble::sim
