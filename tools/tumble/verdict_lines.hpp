// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::tools {

/// Returns the health warnings of an estimate (scenarios::HealthFinding): contradictory inputs, IMUs that are partly
/// unused, or an unknown position on the map. Each warning is one line with the name and the value of its health
/// counter. The list is empty without warnings.
std::vector<std::string> verdict_lines(const scenarios::Estimate& estimate);

}  // namespace tumble::tools
