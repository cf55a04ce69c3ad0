// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::tools {

/// CostRow is the cost of one method on one scenario.
struct CostRow {
  std::string scenario, method;  ///< method: KIND/NAME
  double cpu_s = 0.0;            ///< median CPU time of one estimate
  /// Median of recording duration / CPU time over the simulated runs; above 1, the method is faster than real time on
  /// one processor. The factor is NaN if the results contain no durations.
  double real_time_factor = 0.0;
};

/// Returns the cost of each scenario, kind and method with a CPU time, in O(values * log(draws)).
std::vector<CostRow> cost_rows(const scenarios::Summary& summary, std::span<const scenarios::DrawValues> draws);

/// Returns the cost rows as a folded table.
std::string costs_html(const std::vector<CostRow>& rows);

}  // namespace tumble::tools
