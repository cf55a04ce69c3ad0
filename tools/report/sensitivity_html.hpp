// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

/// Shows the three scenario parameters with the strongest significant influence on each method's failures.
std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

/// Describes how many more runs each scenario needs for the ranking of influences; empty if all scenarios have enough
/// runs.
std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws);

}  // namespace tumble::tools
