// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// The scenario with every number fixed as `situation`, a draw of it, has it, defaults and data sheets included: with
/// that draw's seed it is drawn to the same numbers, whatever becomes of catalogue, sheets and defaults.
Scenario fixed_as(Scenario scenario, const sim::Situation& situation);

/// A scenario without a drawn number as the text of its file: read back it is the same. Throws BadInput where a number
/// is drawn.
std::string to_yaml(const Scenario& scenario);

}  // namespace tumble::scenarios
