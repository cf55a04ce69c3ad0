// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Returns the scenario with every number set as in `situation`, one of its draws, including defaults and data sheets.
/// With that draw's seed, the result reproduces the draw even if the catalogue, data sheets or defaults change later.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

/// Writes a scenario without random numbers as YAML; parsing the text gives the same scenario. Throws BadInput if a
/// number is random.
std::string to_yaml(const Scenario& scenario);

}  // namespace tumble::scenarios
