// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

/// What breaks each method: of the numbers that draws differ in the three strongest that chance does not explain.
/// `note` says of which draws, or why there is nothing.
std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

/// How many more draws each scenario needs, by those that it has: to say what breaks a method, and to draw the score
/// over a number. Empty where all have enough.
std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws);

}  // namespace tumble::tools
