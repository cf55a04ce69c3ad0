// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Parses a scenario from YAML text. Checks the types of components, and checks the range of each distribution against
/// the limits of its parameter in `registry`. Throws BadInput with the file, the line and the name of the faulty value.
Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry);

/// Returns the limits of a scenario's duration, which belongs to no component.
const sim::Parameter& duration_parameter();

/// Parses a data sheet, and checks names, units and limits against the parameters of the sensor's type.
DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

/// Draws every parameter that the scenario and the data sheets contain, without defaults. `sheets` contains one data
/// sheet per sensor of the scenario.
sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
