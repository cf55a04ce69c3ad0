// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Returns the scenario with every random parameter, default and data sheet number replaced by its value in
/// `situation`. With the seed of `situation`, the result reproduces the simulated run even if data sheets, defaults or
/// scenario files change later.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

std::string to_yaml(const Scenario& scenario);

}  // namespace tumble::scenarios
