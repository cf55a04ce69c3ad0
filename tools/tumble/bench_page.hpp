// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/bench/bench.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// The results that a page shows: those that were run now, and those that stood ready.
struct BenchPage {
  std::vector<scenarios::BenchResult> ran, stored;
  std::vector<std::string> left_out;  ///< of the stored ones, each with the reason
};

/// A table per metric that the suite shows, a row per result, a column per class of draws: the median, lost draws as
/// the worst. Then how each result came about, what failed of those that ran (`outcomes` has the reasons), and what was
/// left out.
std::vector<Table> bench_tables(const scenarios::Suite& suite, const BenchPage& page,
                                std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
