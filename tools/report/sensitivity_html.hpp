// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

/// Shows what makes each method fail: the three scenario numbers with the strongest influence that chance does not
/// explain. `note` states the draws used, or why there is no result.
std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

/// States how many more draws each scenario needs, given the number it has: for the ranking of influences, and for the
/// plot of the score as a function of a number. Empty if all scenarios have enough.
std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws);

}  // namespace tumble::tools
