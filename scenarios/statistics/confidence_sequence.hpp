// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// Computes a confidence interval of a probability. The interval may be computed after every trial: with probability 1
/// - `risk`, all intervals of the sequence contain the true probability. The method of Robbins (1970) is used with a
/// uniform mixture, equations (S13) to (S15) of statistics.md. `value` is the fraction of successes, or 0.5
/// without trials. Throws BadInput if a count is negative or `risk` is not within (0, 1).
///
/// Source: Robbins, Annals of Mathematical Statistics 41:1397, 1970.
Interval probability_at_any_time(std::int64_t successes, std::int64_t failures, double risk);

}  // namespace tumble::scenarios
