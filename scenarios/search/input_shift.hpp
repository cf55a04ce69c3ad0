// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/search/splitting.hpp"

namespace tumble::scenarios {

/// InputShift describes how the values of one random parameter in a set of runs, for example all failing runs, differ
/// from the distribution of the parameter in the scenario.
struct InputShift {
  std::string number;
  double shift = 0.0;      ///< mean normal score of the draws [standard deviations of the scenario's distribution]
  double corrected = 1.0;  ///< p-value of a shift of 0, corrected by Holm over all parameters
  double low = 0.0, median = 0.0, high = 0.0;                             ///< quantiles 0.1, 0.5, 0.9 of the draws
  double scenario_low = 0.0, scenario_median = 0.0, scenario_high = 0.0;  ///< those of the scenario's distribution
};

/// Compares the values of each random parameter in a set of draws (random runs) with the scenario's distribution. The
/// parameter with the largest shift comes first. `shift` is averaged over the copies of each initial draw, and then
/// over the initial draws, because copies of one initial draw depend on each other. `corrected` is the p-value by
/// equation (S31) of statistics.md, after Holm's correction. The list `draws` must not be empty.
std::vector<InputShift> input_shifts(std::span<const DrawnNumber> numbers, std::span<const ScoredPoint> draws);

}  // namespace tumble::scenarios
