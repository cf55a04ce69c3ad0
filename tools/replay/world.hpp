// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/replay/replay.hpp"

/// The world of a replay, no finer than its page can carry.
namespace tumble::tools {

/// Triangles of a part, those of a height field's cells included.
std::size_t triangle_count(const sim::MeshPart& part);

/// `parts` with at most `most` triangles, nearly. A height field keeps every node within the box `near` and ever fewer
/// away from it: steps of an eighth of the distance. Of the others the largest for their distance from the box stay.
/// Says in `triangles` how many of how many.
std::vector<sim::MeshPart> thinned_world(std::vector<sim::MeshPart> parts, const Eigen::AlignedBox3f& near,
                                         std::size_t most, Shown& triangles);

/// A body of about the true size for a recording that does not say which robot it was: the sphere of that radius, or a
/// box of 0.3 m by 0.2 m by 0.1 m with a nose along x.
std::vector<sim::MeshPart> plain_body(double sphere_radius_m);

}  // namespace tumble::tools
