// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/suite_triage.hpp"

/// The functions in input_worth.hpp find which true input improves a method most, over many simulated runs
/// (docs/maths/statistics.md).
namespace tumble::scenarios {

/// InputWorth is the effect of replacing one input of a method by its true value. Only simulated runs on which the
/// replacement changed the input count.
struct InputWorth {
  std::string scenario;  ///< empty: all scenarios together
  std::string input, doc;
  std::int64_t draws = 0;
  std::int64_t failed = 0;             ///< failures with the original input
  std::int64_t cured = 0;              ///< failures that the true input removes
  std::int64_t broken = 0;             ///< failures only with the true input
  Interval cured_share{};              ///< fraction of `failed` (Clopper and Pearson, 95 %); NaN if `failed` is 0
  std::int64_t better = 0, worse = 0;  ///< draws, by the metric
  /// The member `improvement` is the median decrease of the metric's badness (`how_bad`), with its BCa interval. Runs
  /// that are not ok rank worst. The interval is NaN if no run has the metric.
  Interval improvement{};
  double chance = 1.0;     ///< p-value of the two-sided signed-rank test
  double corrected = 1.0;  ///< corrected by Holm, over all rows
};

/// Evaluates the effect of each true input for each scenario, and for all scenarios together if there are several. The
/// list is sorted by the fraction of prevented failures, then by p-value. Simulated runs without triage results are
/// omitted.
std::vector<InputWorth> worth_of_inputs(std::span<const DrawTriage> draws, const std::string& metric);

}  // namespace tumble::scenarios
