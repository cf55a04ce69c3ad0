// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// The still picture replaces the animation on paper, for readers who prefer reduced motion, and if there is no
/// animation.
std::string moving_html(const ShownExample& shown);

std::string examples_html(const std::vector<ShownExample>& examples, const Palette& palette,
                          std::vector<Figure>& figures);

std::string failure_html(const ShownExample& shown);

std::string example_id(const std::string& scenario, std::uint64_t seed);

std::string plot_html(const Figure& figure, bool tall = false);

}  // namespace tumble::tools
