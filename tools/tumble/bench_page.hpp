// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/bench/bench.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

struct BenchPage {
  std::vector<scenarios::BenchResult> ran, stored;
  std::vector<std::string> left_out;  ///< with reasons
};

std::vector<Table> bench_tables(const scenarios::Suite& suite, const BenchPage& page,
                                std::span<const scenarios::Outcome> outcomes);

}  // namespace tumble::tools
