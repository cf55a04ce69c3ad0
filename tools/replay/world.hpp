// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/replay/replay.hpp"

/// The functions in world.hpp reduce the world of a replay to a size that fits into the page.
namespace tumble::tools {

/// Counts the triangles of a part, including the triangles of a height field's cells.
std::size_t triangle_count(const sim::MeshPart& part);

/// Reduces `parts` to about `most` triangles. A height field keeps every node within the box `near`. Outside the box,
/// the distance between nodes is one eighth of their distance from the box. Among the other parts, the parts with the
/// largest apparent size from the box are kept. `triangles` returns the number of kept triangles and the total number.
std::vector<sim::MeshPart> thinned_world(std::vector<sim::MeshPart> parts, const Eigen::AlignedBox3f& near,
                                         std::size_t most, Shown& triangles);

/// Returns a generic body for a recording without a known robot: a sphere with the radius, or a box of 0.3 m by 0.2 m
/// by 0.1 m with a nose along x.
std::vector<sim::MeshPart> plain_body(double sphere_radius_m);

}  // namespace tumble::tools
