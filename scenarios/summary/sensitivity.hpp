// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/statistics/dependence.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/outcome.hpp"

/// What breaks a method: each score against each number that its draws differ in (docs/maths/statistics.md).
namespace tumble::scenarios {

/// Below it a corrected chance does not explain an influence.
inline constexpr double kInfluenceRisk = 0.05;

/// Numbers of the draws of a scenario, by what they are called; each by rising seed.
using NumbersOfDraws = std::map<std::string, std::vector<RankedValue>>;

/// Those that the scenario draws, over the seeds that the summary has of it.
NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario);
/// What the motion was like: an effect as the scores are, of the same cause or of another. Of one scenario.
NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario);

/// What one number has to do with one score.
struct Influence {
  std::string number;
  Correlation correlation;  ///< with the badness: above 0 where larger numbers are worse
  FirstOrder first_order;   ///< of the ranks of the score
  double corrected = 1.0;   ///< chance of both being so large, by Holm over all numbers of the row
  /// Median of the score over the quarter of the draws with the lowest and with the highest numbers.
  double median_low = 0.0, median_high = 0.0;
  /// Median of the score, or share that has failed, over classes of the number: its partial dependence.
  std::vector<DependenceClass> dependence = {};
  /// What the influence is ranked by: the larger of the index and the square of rho.
  double strength() const;
};

/// One metric of one method on one scenario; `metric` is "not ok" for whether it failed.
struct Sensitivity {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;
  std::vector<Influence> influences;  ///< the strongest first
};

struct SensitivityOptions {
  std::vector<std::string> methods;  ///< "rate/tumble" or "tumble"; empty: all that need no truth
  std::vector<std::string> metrics;  ///< empty: the headline ones of each kind
};

/// Draws that a row needs, and of "not ok" how many of either sort. Below 24 the rank correlation speaks alone.
inline constexpr std::size_t kSensitivityDrawsMin = 12, kSensitivityFailuresMin = 5;

/// Of the sections of scenarios that `numbers` has, in their order; rows of fewer draws are left out. A failed run
/// ranks as the worst. Throws BadInput on a method or metric that the results do not hold.
std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options);

}  // namespace tumble::scenarios
