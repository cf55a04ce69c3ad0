// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

struct Scene {
  const sim::BuiltSituation* built = nullptr;
  const sim::Sensors* sensors = nullptr;  ///< needed with `truth` to draw the robot along the true path
  const sim::Truth* truth = nullptr;
  std::vector<Path> estimates;  ///< estimate i has the colour method_colour(i)
};

sim::Picture scene_picture(const Scene& scene, int robots, int width, int height);

sim::Picture film_picture(const Scene& scene, int frames, int columns, int width, int height);

/// Throws scenarios::BadInput with the path if the file cannot be written.
void save_picture(const std::filesystem::path& path, const sim::Picture& picture);

}  // namespace tumble::tools
