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

/// sensitivity.hpp computes how the scores of a method depend on each random parameter of its simulated runs
/// (docs/maths/statistics.md).
namespace tumble::scenarios {

/// An influence is significant if its corrected p-value is at most kInfluenceRisk.
inline constexpr double kInfluenceRisk = 0.05;

/// NumbersOfDraws contains the values of the random parameters of a scenario's simulated runs, by parameter name. Each
/// list is sorted by seed.
using NumbersOfDraws = std::map<std::string, std::vector<RankedValue>>;

/// Returns the values of the scenario's random parameters for the seeds in the summary.
NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario);
/// Returns the motion values of a scenario's simulated runs, for example the peak rate. A motion value is an effect of
/// the random parameters; its dependence with a score may have a common cause.
NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario);

/// Influence is the influence of one random parameter on one score.
struct Influence {
  std::string number;
  Correlation correlation;  ///< with the badness; positive if larger parameter values are worse
  FirstOrder first_order;   ///< first-order index of the ranks of the score
  double corrected = 1.0;   ///< p-value of both statistics, corrected by Holm over all parameters of the row
  /// Median scores over the quarters of the runs with the lowest and with the highest parameter values.
  double median_low = 0.0, median_high = 0.0;
  /// Partial dependence: median score, or fraction of failures, over classes of the parameter value.
  std::vector<DependenceClass> dependence = {};
  /// Returns the larger of the first-order index and the squared rank correlation, by which influences are sorted.
  double strength() const;
};

/// Sensitivity contains the influence of all random parameters on one metric of one method in one scenario. For the
/// influence on failures, `metric` is "not ok".
struct Sensitivity {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;
  std::vector<Influence> influences;  ///< strongest first
};

struct SensitivityOptions {
  std::vector<std::string> methods;  ///< "rate/tumble" or "tumble"; empty: all methods without truth
  std::vector<std::string> metrics;  ///< empty: the headline metrics of each kind
};

/// A row of the table needs at least kSensitivityDrawsMin simulated runs. The row "not ok" needs at least
/// kSensitivityFailuresMin failures and as many successes. Below 24 runs, only the rank correlation is computed.
inline constexpr std::size_t kSensitivityDrawsMin = 12, kSensitivityFailuresMin = 5;

/// Computes the sensitivities of all methods in the scenarios of `numbers`, in the order of the summary's sections.
/// Rows with too few simulated runs are omitted. Failed runs rank worst. Throws BadInput for a method or metric that
/// the results lack.
std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options);

}  // namespace tumble::scenarios
