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

/// sensitivity.hpp computes how a method's scores depend on each random number of its simulated runs
/// (docs/maths/statistics.md).
namespace tumble::scenarios {

/// kInfluenceRisk is the largest corrected p-value of a significant influence.
inline constexpr double kInfluenceRisk = 0.05;

/// NumbersOfDraws contains the random numbers of a scenario's simulated runs by name. Each list of numbers is sorted by
/// seed.
using NumbersOfDraws = std::map<std::string, std::vector<RankedValue>>;

/// Returns the scenario's random numbers for the summary's seeds.
NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario);
/// Returns the motion values of the simulated runs of one scenario. Motion values are effects like the scores, and may
/// share their causes.
NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario);

/// Influence is the influence of one number on one score.
struct Influence {
  std::string number;
  Correlation correlation;  ///< correlation with the badness; positive if larger numbers are worse
  FirstOrder first_order;   ///< of the ranks of the score
  double corrected = 1.0;   ///< p-value of both statistics, corrected by Holm over all numbers of the row
  /// Median of the score over the quarter of the runs with the lowest numbers, and over the quarter with the highest
  /// numbers.
  double median_low = 0.0, median_high = 0.0;
  /// Partial dependence: median of the score, or fraction of failures, over classes of the number.
  std::vector<DependenceClass> dependence = {};
  /// Returns the larger of the first-order index and the square of the rank correlation. The list of influences is
  /// sorted by this strength.
  double strength() const;
};

/// Sensitivity is the sensitivity of one metric of one method on one scenario. For failures, `metric` is "not ok".
struct Sensitivity {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;
  std::vector<Influence> influences;  ///< strongest first
};

struct SensitivityOptions {
  std::vector<std::string> methods;  ///< "rate/tumble" or "tumble"; empty: all that need no truth
  std::vector<std::string> metrics;  ///< empty: the headline metrics of each kind
};

/// kSensitivityDrawsMin is the minimum number of simulated runs for a row of the table; kSensitivityFailuresMin is the
/// minimum number of failures, and of successes, for the row "not ok". With fewer than 24 simulated runs, only the rank
/// correlation is used.
inline constexpr std::size_t kSensitivityDrawsMin = 12, kSensitivityFailuresMin = 5;

/// Analyses the sections whose scenarios are in `numbers`, in the order of the sections. Rows with too few simulated
/// runs are omitted. Failed runs rank worst. Throws BadInput for a method or metric that the results do not contain.
std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options);

}  // namespace tumble::scenarios
