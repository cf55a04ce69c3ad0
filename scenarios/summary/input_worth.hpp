// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/suite_triage.hpp"

/// Which input's truth matters most to a method, over many draws (docs/maths/statistics.md).
namespace tumble::scenarios {

/// One input replaced by its truth, over the draws in which there was something to replace.
struct InputWorth {
  std::string scenario;  ///< empty: of all together
  std::string input, doc;
  std::int64_t draws = 0;
  std::int64_t failed = 0;             ///< as they were
  std::int64_t cured = 0;              ///< of these, that do not fail with the true input
  std::int64_t broken = 0;             ///< that fail with it alone
  Interval cured_share{};              ///< of the failed ones (Clopper and Pearson, 95 %); NaN without any
  std::int64_t better = 0, worse = 0;  ///< draws, by the metric
  /// Median of what the truth takes off the metric's badness (`how_bad`), a run that is not ok ranking as the worst,
  /// with its BCa interval; NaN where no draw has the metric.
  Interval improvement{};
  double chance = 1.0;     ///< of such differences without an effect: signed-rank test, two-sided
  double corrected = 1.0;  ///< by Holm, over all rows
};

/// Of each scenario, and of all together where there are several; the input that cures the largest share of failures
/// first, of equal ones the one whose pairs are the least likely by chance. Draws without rows are left out.
std::vector<InputWorth> worth_of_inputs(std::span<const DrawTriage> draws, const std::string& metric);

}  // namespace tumble::scenarios
