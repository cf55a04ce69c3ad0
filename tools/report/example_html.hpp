// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Shows the animation of a run with a link to the replay. The still picture replaces it on paper, for readers who
/// prefer reduced motion, and if there is no animation.
std::string moving_html(const ShownExample& shown);

/// Shows single runs with pictures and plots, which are appended to `figures`. All examples but the first are folded.
std::string examples_html(const std::vector<ShownExample>& examples, const Palette& palette,
                          std::vector<Figure>& figures);

/// Shows the picture of a run with failed methods, folded. `examples_html` omits these runs.
std::string failure_html(const ShownExample& shown);

/// Returns the id of the element that shows a run, for links from other parts of the page.
std::string example_id(const std::string& scenario, std::uint64_t seed);

/// Returns the placeholder element of a plot.
std::string plot_html(const Figure& figure, bool tall = false);

}  // namespace tumble::tools
