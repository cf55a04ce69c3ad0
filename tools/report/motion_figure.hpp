// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

/// The density of all draws over rate and specific force, both logarithmic, their points scenario by scenario, and the
/// published extremes as outlines. Empty without draws.
Figure motion_figure(const scenarios::MotionMap& map);

}  // namespace tumble::tools
