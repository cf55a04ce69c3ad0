// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry);

const sim::Parameter& duration_parameter();

DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry);

sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed);

}  // namespace tumble::scenarios
