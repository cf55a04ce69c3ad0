// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

/// Plots the density of all runs over rate and specific force (both logarithmic), and the published maxima as outlines.
Figure motion_figure(const scenarios::MotionMap& map);

}  // namespace tumble::tools
