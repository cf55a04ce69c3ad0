// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

std::vector<Table> score_tables(const std::string& title, std::span<const scenarios::Outcome> outcomes,
                                const std::string& status = "");

nlohmann::json score_rows(std::span<const scenarios::Outcome> outcomes);

nlohmann::json outcome_rows(std::span<const scenarios::Outcome> outcomes);

std::string overall_status(std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
