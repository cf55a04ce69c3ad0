// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/scoring/truth_track.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"
#include "tools/pictures/pictures.hpp"

/// staging.hpp provides viewpoints, times and paths for pictures and animations.
namespace tumble::tools {

bool is_sphere(const Scene& scene);

/// Returns times that divide the moving part of the path into parts of equal length. Rotation adds a small length.
std::vector<std::int64_t> instants_along(const sim::Truth& truth, int count);

/// Returns the true path and the estimated paths with their colours.
std::vector<sim::DrawnPath> drawn_paths(const Scene& scene);

/// Returns the azimuth of a view across the direction of travel, in which slopes are visible.
double azimuth_across_rad(const sim::Truth& truth);

/// Returns the true pose T_WB.
Eigen::Isometry3d robot_pose(const scenarios::TruthTrack& track, std::int64_t time_ns);

}  // namespace tumble::tools
