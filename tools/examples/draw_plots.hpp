// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/paths.hpp"

/// Plots of one draw, whatever the robot.
namespace tumble::tools {

/// The paths of the estimates of a run that have one and were not given the truth, which they lie on and would hide.
struct RunPaths {
  std::vector<std::string> methods;  ///< "slam/icp"
  std::vector<Path> paths;           ///< parallel
};
RunPaths paths_of(const scenarios::RunResult& run);

/// Five significant digits: more than a plot can show, and they keep the page small.
double significant(double value);

/// Rate about the sensor axis that clips most, over the moving part: the truth, the gyro, and each rate method's
/// answer. Without lines when the recording has no clipped sample.
Plot rate_plot(const scenarios::RunResult& run);

/// The way seen from above, at equal scales: the truth and each path.
Plot path_plot(const scenarios::RunResult& run, const RunPaths& paths);

}  // namespace tumble::tools
