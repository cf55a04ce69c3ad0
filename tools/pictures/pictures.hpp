// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/scoring/truth_track.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

struct Scene {
  const sim::BuiltSituation* built = nullptr;
  const sim::Sensors* sensors = nullptr;  ///< required to draw the robot
  const sim::Truth* truth = nullptr;
  std::vector<Path> estimates;  ///< in the order of method_colour
};

sim::Picture scene_picture(const Scene& scene, int robots, int width, int height);

sim::Picture film_picture(const Scene& scene, int frames, int columns, int width, int height);

void save_picture(const std::filesystem::path& path, const sim::Picture& picture);

bool is_sphere(const Scene& scene);

std::vector<std::int64_t> instants_along(const sim::Truth& truth, int count);

std::vector<sim::DrawnPath> drawn_paths(const Scene& scene);

double azimuth_across_rad(const sim::Truth& truth);

Eigen::Isometry3d robot_pose(const scenarios::TruthTrack& track, std::int64_t time_ns);

}  // namespace tumble::tools
