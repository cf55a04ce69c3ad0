// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Returns a copy of `scenario` in which every random parameter has the constant value from the simulated run
/// `situation`. Later changes of data sheets and default values do not affect runs of the returned scenario.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

std::string to_yaml(const Scenario& scenario);

void fix_number(Scenario& scenario, const std::string& key, double value);

}  // namespace tumble::scenarios
