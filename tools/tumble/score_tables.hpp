// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// Returns one table per kind: one row per metric in the order of first occurrence, one column per method, with the
/// status in the first row. A non-empty `status` replaces the status of the outcomes.
std::vector<Table> score_tables(const std::string& title, std::span<const scenarios::Outcome> outcomes,
                                const std::string& status = "");

/// Returns the scores as rows (scenario, seed, kind, method, status, metric, value), as in the results database.
nlohmann::json score_rows(std::span<const scenarios::Outcome> outcomes);

/// Returns kind, method, status, message and digest of every outcome.
nlohmann::json outcome_rows(std::span<const scenarios::Outcome> outcomes);

/// Returns `ok` if all outcomes are ok, or else the first other status.
std::string overall_status(std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
