// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

/// Plots the density of all runs over rate and specific force (both logarithmic), the runs as points by scenario, and
/// the published maxima as outlines. The figure is empty without runs.
Figure motion_figure(const scenarios::MotionMap& map);

}  // namespace tumble::tools
