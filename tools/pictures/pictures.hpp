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

/// What pictures are made from. Only the first is needed.
struct Scene {
  const sim::BuiltSituation* built = nullptr;
  const sim::Sensors* sensors = nullptr;  ///< with `truth`: the robot along its path and the true path
  const sim::Truth* truth = nullptr;
  std::vector<Path> estimates;  ///< drawn in method_colour(0), (1), ...
};

/// The whole path in one picture: world, robot at `robots` instants equally far apart along it, true and estimated
/// paths. Without truth the world and the estimates alone.
sim::Picture scene_picture(const Scene& scene, int robots, int width, int height);

/// `frames` close-ups at instants equally far apart along the path, in rows of `columns`. Needs the truth.
sim::Picture film_picture(const Scene& scene, int frames, int columns, int width, int height);

/// Writes a PNG; throws scenarios::BadInput with the path when it cannot.
void save_picture(const std::filesystem::path& path, const sim::Picture& picture);

}  // namespace tumble::tools
