// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Returns the scenario with every random parameter replaced by its value in `situation`, which was drawn from the
/// scenario. The result includes defaults and the numbers of data sheets. With the seed of `situation`, it reproduces
/// the simulated run even if data sheets, defaults or scenario files change later.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

/// Converts a scenario without random parameters to YAML. Parsing the text gives an equal scenario. Throws BadInput if
/// a parameter is random.
std::string to_yaml(const Scenario& scenario);

}  // namespace tumble::scenarios
