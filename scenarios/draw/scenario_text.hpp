// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Parses a scenario and checks it against `registry`: types, numbers, and the range of each distribution against the
/// parameter's bounds. Messages start with `file`. Throws BadInput with file, line and place.
Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry);

/// Bounds of a scenario's duration, which belongs to no component.
const sim::Parameter& duration_parameter();

/// Parses a data sheet and checks names, units and bounds against the parameters of its kind of sensor.
DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

/// Draws every number that the scenario and the data sheets state; does not fill in defaults. `sheets` has one entry
/// per sensor of the scenario.
sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
