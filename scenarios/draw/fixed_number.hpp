// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

void fix_number(Scenario& scenario, const std::string& key, double value);

}  // namespace tumble::scenarios
