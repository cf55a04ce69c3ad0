// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/paths.hpp"

/// Plots of one draw, whatever the robot.
namespace tumble::tools {

/// Which of several methods are drawn, rising: all, or, where they are more than there are colours, those that come
/// `first` and then others, each in order, as long as there is a colour of its own.
std::vector<std::size_t> drawn_of(const std::vector<bool>& first);

/// The paths of the estimates of a run that have one and were not given the truth, which they lie on and would hide. Of
/// more than there are colours the baseline and ours come first.
struct RunPaths {
  std::vector<std::string> methods;  ///< "slam/icp"
  std::vector<Path> paths;           ///< parallel
  std::size_t left_out = 0;          ///< that have a path and no colour
  std::string left_out_text() const;
};
RunPaths paths_of(const scenarios::RunResult& run);

/// Five significant digits: more than a plot can show, and they keep the page small.
double significant(double value);

/// Rate about the sensor axis that clips most, over the moving part: the truth, the gyro, and each rate method's
/// answer. Without lines when the recording has no clipped sample.
Plot rate_plot(const scenarios::RunResult& run);

/// The path seen from above, at equal scales: the truth and each path.
Plot path_plot(const scenarios::RunResult& run, const RunPaths& paths);

}  // namespace tumble::tools
