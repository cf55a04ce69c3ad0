// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/bench/bench.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// BenchPage contains the results on a page: those of this run, and stored results.
struct BenchPage {
  std::vector<scenarios::BenchResult> ran, stored;
  std::vector<std::string> left_out;  ///< stored results that are not on the page, each with the reason
};

/// Returns one table per metric of the suite, with one row per method and one column per class of simulated runs. The
/// cells are medians; failed runs rank worst. Further tables show the origin of each result, the failures of this run
/// (reasons from `outcomes`), and stored results that are not on the page.
std::vector<Table> bench_tables(const scenarios::Suite& suite, const BenchPage& page,
                                std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
