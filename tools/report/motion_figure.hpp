// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

Figure motion_figure(const scenarios::MotionMap& map);

}  // namespace tumble::tools
