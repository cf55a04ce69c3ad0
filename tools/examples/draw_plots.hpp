// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

/// If there are more methods than colours, methods marked `first` have priority.
std::vector<std::size_t> drawn_of(const std::vector<bool>& first);

/// Paths of methods with truth would hide the true path and are omitted. If there are more paths than colours, the
/// baseline and the methods of tumble have priority.
struct RunPaths {
  std::vector<std::string> methods;  ///< for example "slam/icp"
  std::vector<Path> paths;           ///< parallel to `methods`
  std::size_t left_out = 0;          ///< number of methods that have a path but no colour
  std::string left_out_text() const;
};
RunPaths paths_of(const scenarios::RunResult& run);

/// Five significant digits are finer than a plot can show, and keep the page small.
double significant(double value);

/// Plots the rate about the sensor axis that clips most during motion: the truth, the gyro and each rate method.
/// Without clipped samples, the plot has no lines.
Plot rate_plot(const scenarios::RunResult& run);

Plot path_plot(const scenarios::RunResult& run, const RunPaths& paths);

}  // namespace tumble::tools
