// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Returns the scenario with every number fixed to its value in `situation`, which was drawn from the scenario. The
/// fixed numbers include defaults and numbers of data sheets. With the seed of `situation`, the fixed scenario
/// reproduces the simulated run, even if the catalogue, data sheets or defaults change later.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

/// Returns a scenario without random numbers as YAML. Parsing the text gives an equal scenario. Throws BadInput if a
/// number is random.
std::string to_yaml(const Scenario& scenario);

}  // namespace tumble::scenarios
