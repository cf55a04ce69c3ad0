// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/suite_triage.hpp"

/// The functions in input_worth.hpp compute how much a method improves if the true value replaces one of its inputs
/// (docs/maths/statistics.md).
namespace tumble::scenarios {

struct InputWorth {
  std::string scenario;  ///< empty: all scenarios
  std::string input, doc;
  std::int64_t draws = 0;
  std::int64_t failed = 0;             ///< with the estimated input
  std::int64_t cured = 0;              ///< successes with the true input
  std::int64_t broken = 0;             ///< failures only with the true input
  Interval cured_share{};              ///< `cured` / `failed`, 95 % interval
  std::int64_t better = 0, worse = 0;  ///< runs with a better or worse metric
  /// Median decrease of how_bad() (larger for worse metric values) if the method gets the true input, with a
  /// bias-corrected bootstrap interval (BCa). A run whose status is not ok counts as the worst value of the metric.
  Interval improvement{};
  double chance = 1.0;     ///< two-sided signed-rank test
  double corrected = 1.0;  ///< `chance` after Holm's correction
};

std::vector<InputWorth> worth_of_inputs(std::span<const DrawTriage> draws, const std::string& metric);

}  // namespace tumble::scenarios
