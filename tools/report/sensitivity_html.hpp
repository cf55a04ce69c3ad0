// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

/// What breaks each method: of the numbers that draws differ in the three strongest that chance does not explain.
/// `note` says of which draws, or why there is nothing.
std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

}  // namespace tumble::tools
