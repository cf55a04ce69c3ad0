// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

std::size_t triangle_count(const sim::MeshPart& part);

/// A height field keeps every node in the bounding box `near`; outside, the step between nodes is one eighth of their
/// distance from `near`.
std::vector<sim::MeshPart> thinned_world(std::vector<sim::MeshPart> parts, const Eigen::AlignedBox3f& near,
                                         std::size_t most, Shown& triangles);

/// A recording without a known robot shows a sphere of this radius, or a box of 0.3 m by 0.2 m by 0.1 m with a nose
/// along x.
std::vector<sim::MeshPart> plain_body(double sphere_radius_m);

}  // namespace tumble::tools
