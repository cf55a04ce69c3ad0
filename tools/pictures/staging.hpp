// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/scoring/truth_track.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"
#include "tools/pictures/pictures.hpp"

namespace tumble::tools {

bool is_sphere(const Scene& scene);

std::vector<std::int64_t> instants_along(const sim::Truth& truth, int count);

std::vector<sim::DrawnPath> drawn_paths(const Scene& scene);

double azimuth_across_rad(const sim::Truth& truth);

Eigen::Isometry3d robot_pose(const scenarios::TruthTrack& track, std::int64_t time_ns);

}  // namespace tumble::tools
