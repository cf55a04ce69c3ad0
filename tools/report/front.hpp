// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/page.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

std::string front_html(const PageContent& content);

Figure motion_figure(const scenarios::MotionMap& map);

}  // namespace tumble::tools
