// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// Confidence interval of a probability that may be computed after every trial: with probability 1 - `risk`, the
/// intervals after all numbers of trials contain the true probability (Robbins, Ann. Math. Stat. 41:1397, 1970, with a
/// uniform mixture; equations (S13) to (S15) of statistics.md). `value` is the share of successes; 0.5 without trials.
/// Throws BadInput if a count is negative or `risk` is not within (0, 1).
Interval probability_at_any_time(std::int64_t successes, std::int64_t failures, double risk);

}  // namespace tumble::scenarios
