// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::tools {

/// What an estimate says against itself (scenarios::Doubt): inputs that cannot be what they claim, units
/// of which a part of the readings is not in use, a place that is not known. One line each, which names the row of the
/// health with its value; none where all is well.
std::vector<std::string> verdict_lines(const scenarios::Estimate& estimate);

}  // namespace tumble::tools
