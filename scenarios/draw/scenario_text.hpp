// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

/// Returns the base that the value of the key `extends` names. Errors name the line of this key.
using LoadBase = std::function<Scenario(const YamlNode& extends)>;

[[noreturn]] Scenario refuse_base(const YamlNode& extends);

/// Returns the scenario of the text. If the text has the key `extends`, the base supplies the missing values:
/// - `duration_s`, `streams` and the parts `world`, `robot` and `motion`, if the text lacks the key.
/// - The numbers of a part that the text lacks. A part with the key `type` inherits nothing.
/// - The sensors, and the values of a sensor of the same name. A sensor with the key `kind` inherits nothing.
Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry,
                        const LoadBase& load_base = refuse_base);

const sim::Parameter& duration_parameter();

DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
