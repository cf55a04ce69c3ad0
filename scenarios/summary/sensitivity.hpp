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

/// The functions in sensitivity.hpp compute how the scores of a method depend on each random number of its simulated
/// runs (docs/maths/statistics.md).
namespace tumble::scenarios {

/// An influence is significant if its corrected p-value is at most kInfluenceRisk.
inline constexpr double kInfluenceRisk = 0.05;

/// NumbersOfDraws contains the random numbers of a scenario's simulated runs by name. Each list of numbers is sorted by
/// seed.
using NumbersOfDraws = std::map<std::string, std::vector<RankedValue>>;

/// Returns the random numbers of a scenario for the seeds in the summary.
NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario);
/// Returns the motion values of a scenario's simulated runs, for example the peak rate. Motion values are effects like
/// the scores, and both may have the same causes.
NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario);

/// Influence is the influence of one random number on one score.
struct Influence {
  std::string number;
  Correlation correlation;  ///< correlation with the badness; positive if larger numbers are worse
  FirstOrder first_order;   ///< of the ranks of the score
  double corrected = 1.0;   ///< p-value of both statistics, corrected by Holm over all numbers of the row
  /// The member `median_low` is the median score over the quarter of the runs with the lowest numbers; `median_high` is
  /// that of the highest numbers.
  double median_low = 0.0, median_high = 0.0;
  /// The partial dependence is the median score, or the fraction of failures, over classes of the number.
  std::vector<DependenceClass> dependence = {};
  /// Returns the larger of the first-order index and the square of the rank correlation. Influences are sorted by their
  /// strength.
  double strength() const;
};

/// Sensitivity contains the influence of all random numbers on one metric of one method in one scenario. If the
/// sensitivity is that of failures, `metric` is "not ok".
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

/// kSensitivityDrawsMin is the smallest number of simulated runs for a row of the table; kSensitivityFailuresMin is the
/// smallest number of failures, and of successes, for the row "not ok". With fewer than 24 simulated runs, only the
/// rank correlation is used.
inline constexpr std::size_t kSensitivityDrawsMin = 12, kSensitivityFailuresMin = 5;

/// Computes the sensitivities of all methods in the scenarios of `numbers`, in the order of the summary's sections.
/// Rows with too few simulated runs are omitted. Failed runs rank worst. Throws BadInput for a method or metric that
/// the results do not contain.
std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options);

}  // namespace tumble::scenarios
