// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scenarios/search/failure_search.hpp"
#include "tools/tables/table.hpp"

/// search_tables.hpp formats the result of a search for failures on one scenario.
namespace tumble::tools {

/// ShownDraw is a draw of a search with the command that reproduces it.
struct ShownDraw {
  scenarios::FoundFailure found;
  std::string command;
};

struct ShownSearch {
  std::string scenario, method;
  scenarios::FailureGoal goal;
  scenarios::SearchResult result;
  std::vector<ShownDraw> draws;  ///< most likely failures, or the worst draw
};

/// Returns the number of independent draws whose failures would give an equally narrow interval.
double plain_draws(const scenarios::Interval& probability);

/// Returns four tables: probability, levels, shifts of the random parameters, and draws. Empty tables are omitted.
std::vector<Table> tables_of(const ShownSearch& shown);
nlohmann::json json_of(const ShownSearch& shown);

}  // namespace tumble::tools
