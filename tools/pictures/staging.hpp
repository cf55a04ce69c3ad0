// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/scoring/truth_track.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"
#include "tools/pictures/pictures.hpp"

/// What stands in a scene, when, and from where it is looked at: the same for pictures that stand and that move.
namespace tumble::tools {

bool is_sphere(const Scene& scene);

/// Instants that cut the moving part of the path into parts of equal length; turning on the spot counts a little too.
std::vector<std::int64_t> instants_along(const sim::Truth& truth, int count);

/// The true path and those of the estimates, in their colours.
std::vector<sim::DrawnPath> drawn_paths(const Scene& scene);

/// Looks across the direction of travel, from the side and somewhat above, so that a slope shows as one.
double azimuth_across_rad(const sim::Truth& truth);

/// T_WB by the truth.
Eigen::Isometry3d robot_pose(const scenarios::TruthTrack& track, std::int64_t time_ns);

}  // namespace tumble::tools
