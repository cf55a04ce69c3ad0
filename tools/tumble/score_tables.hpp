// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// One table per kind: a row per metric, a column per method, the status first. Metrics in the order in which they
/// come. `status`: what is said in the place of the outcomes' own, where it is more.
std::vector<Table> score_tables(const std::string& title, std::span<const scenarios::Outcome> outcomes,
                                const std::string& status = "");

/// The outcomes' numbers as rows (scenario, seed, kind, method, status, metric, value), as in the results database.
nlohmann::json score_rows(std::span<const scenarios::Outcome> outcomes);

/// Every outcome without its numbers: kind, method, status, message, digest.
nlohmann::json outcome_rows(std::span<const scenarios::Outcome> outcomes);

/// `ok` when every outcome is; else the first other status.
std::string overall_status(std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
