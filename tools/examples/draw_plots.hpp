// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

std::vector<std::size_t> drawn_of(const std::vector<bool>& first);

struct RunPaths {
  std::vector<std::string> methods;  ///< for example "slam/icp"
  std::vector<Path> paths;           ///< parallel to `methods`
  std::size_t left_out = 0;          ///< methods without a colour
  std::string left_out_text() const;
};
RunPaths paths_of(const scenarios::RunResult& run);

double significant(double value);

Plot rate_plot(const scenarios::RunResult& run);

Plot path_plot(const scenarios::RunResult& run, const RunPaths& paths);

Plot sphere_track_plot(const scenarios::RunResult& run);
Plot sphere_speed_plot(const scenarios::RunResult& run);
Plot sphere_height_plot(const scenarios::RunResult& run);
Plot sphere_standstill_plot(const scenarios::RunResult& run);

}  // namespace tumble::tools
