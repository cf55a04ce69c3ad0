// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

std::vector<Table> score_tables(const std::string& title, std::span<const scenarios::Outcome> outcomes,
                                const std::string& status = "");

nlohmann::json score_rows(std::span<const scenarios::Outcome> outcomes);

nlohmann::json outcome_rows(std::span<const scenarios::Outcome> outcomes);

std::string overall_status(std::span<const scenarios::Outcome> outcomes);

std::string interval_text(const scenarios::Interval& interval);
nlohmann::json finite(double value);
nlohmann::json interval_json(const scenarios::Interval& interval);

}  // namespace tumble::tools
