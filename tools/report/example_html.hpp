// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Shows the animation of a draw with a link to its replay. On paper, and for readers who prefer reduced motion, the
/// still picture is shown. The still picture also replaces a missing animation.
std::string moving_html(const ShownExample& shown);

/// Shows single draws with pictures and plots; appends the plots to `figures`. The first example is open, the others
/// are folded.
std::string examples_html(const std::vector<ShownExample>& examples, std::vector<Figure>& figures);

/// Shows the picture of a draw with failed methods, folded. `examples_html` leaves these draws out.
std::string failure_html(const ShownExample& shown);

/// Id of the element that shows a draw; other parts of the page link to it.
std::string example_id(const std::string& scenario, std::uint64_t seed);

/// Placeholder element of a plot.
std::string plot_html(const Figure& figure, bool tall = false);

}  // namespace tumble::tools
