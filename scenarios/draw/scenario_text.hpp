// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// The scenario that `text` holds, checked against `registry`: types, numbers, and the reach of each distribution
/// against the parameter's bounds. `file` begins the messages. Throws BadInput with file, line and place.
Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry);

/// Bounds of a scenario's duration, which belongs to no component.
const sim::Parameter& duration_parameter();

/// The data sheet that `text` holds, checked against the parameters of its kind of sensor: names, units, bounds.
DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

/// Draws every number that the scenario and the data sheets give; defaults are not filled in. `sheets` runs parallel to
/// the scenario's sensors.
sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
