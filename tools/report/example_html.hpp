// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// The picture of a draw that moves by itself, and stands still on paper and for readers who ask for less motion; one
/// that stands where there is none that moves. With a link to its replay.
std::string moving_html(const ShownExample& shown);

/// Single draws with their pictures and plots, which are added to `figures`; the first open, the others folded.
std::string examples_html(const std::vector<ShownExample>& examples, std::vector<Figure>& figures);

/// The picture of a draw on which methods failed, folded; examples_html leaves it out.
std::string failure_html(const ShownExample& shown);

/// Of the element that shows a draw: what other parts of the page link to.
std::string example_id(const std::string& scenario, std::uint64_t seed);

/// A plot's place in the page.
std::string plot_html(const Figure& figure, bool tall = false);

}  // namespace tumble::tools
