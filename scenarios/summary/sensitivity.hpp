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

namespace tumble::scenarios {

inline constexpr double kInfluenceRisk = 0.05;

/// Values of each random parameter in the simulated runs of a scenario, by parameter name. The values of a parameter
/// are sorted by seed.
using NumbersOfDraws = std::map<std::string, std::vector<RankedValue>>;

NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario);
/// Returns motion values of the runs, for example the peak rate. Motion values are effects of the random parameters, so
/// a correlation between a motion value and a score may have a common cause.
NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario);

struct Influence {
  std::string number;
  Correlation correlation;  ///< positive: larger is worse
  FirstOrder first_order;   ///< of the score's ranks
  double corrected = 1.0;   ///< p-value after Holm's correction
  /// Median score over the quarter of the runs with the lowest parameter values, and over the quarter with the highest
  /// parameter values.
  double median_low = 0.0, median_high = 0.0;
  std::vector<DependenceClass> dependence = {};
  double strength() const;
};

struct Sensitivity {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;
  std::vector<Influence> influences;  ///< strongest first
};

struct SensitivityOptions {
  std::vector<std::string> methods;  ///< empty: all methods without truth
  std::vector<std::string> metrics;  ///< empty: the headline metrics
};

inline constexpr std::size_t kSensitivityDrawsMin = 12, kSensitivityFailuresMin = 5;

/// Computes the influence of each random parameter on each metric. Combinations of scenario, method and metric with too
/// few simulated runs are omitted. Failed runs count as the worst values of the metric.
std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options);

}  // namespace tumble::scenarios
