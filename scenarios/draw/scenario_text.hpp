// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

using LoadBase = std::function<Scenario(const YamlNode& extends)>;

[[noreturn]] Scenario refuse_base(const YamlNode& extends);

/// Parses a scenario from YAML text. If the text has the key `extends`, the base scenario supplies values that the text
/// omits:
/// - `duration_s`, `streams`, and the whole parts `world`, `robot` and `motion`,
/// - single numbers of a part, unless the text sets the `type` of the part,
/// - whole sensors, and single values of a sensor with the same name, unless the text sets the `kind` of the sensor.
Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry,
                        const LoadBase& load_base = refuse_base);

const sim::Parameter& duration_parameter();

DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
