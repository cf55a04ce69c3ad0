// SPDX-License-Identifier: BSD-3-Clause
// This header declares the functions that write the sections of a report page.
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/motion_map.hpp"
#include "tools/report/page.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

std::string front_html(const PageContent& content);

Figure motion_figure(const scenarios::MotionMap& map);

std::string failures_html(const PageContent& content);

/// The still picture replaces the animation on paper, for readers who prefer reduced motion, and if there is no
/// animation.
std::string moving_html(const ShownExample& shown);

std::string examples_html(const std::vector<ShownExample>& examples, const Palette& palette,
                          std::vector<Figure>& figures);

std::string failure_html(const ShownExample& shown);

std::string example_id(const std::string& scenario, std::uint64_t seed);

std::string plot_html(const Figure& figure, bool tall = false);

}  // namespace tumble::tools
