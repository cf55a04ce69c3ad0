// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenarios/scoring/metric.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// How the values of the metric of this name are shown.
inline MetricStyle metric_style(const std::string& metric) {
  return style_of(metric_info(metric).unit);
}

/// Position of a method in the registry; unknown names stand behind the known ones.
std::size_t method_rank(Kind kind, const std::string& name);

/// Draws on which one method was better than the baseline, of those that both have a value for.
struct Wins {
  std::int64_t count = 0, pairs = 0;
};

/// One metric of one method over all draws of a scenario. Only outcomes with status `ok` give values; an outcome that
/// failed ranks as the worst value of all in median, quantile and pairs (a draw that gives no method a value of this
/// metric does not count), so a median is infinite once half of the runs fail.
struct MetricSummary {
  Interval centre{};  ///< median, or for a verdict its share; with the 95 % interval
  double quantile_95 = 0.0;
  std::vector<std::uint64_t> seeds;   ///< rising
  std::vector<double> values;         ///< parallel to `seeds`
  std::vector<std::uint64_t> failed;  ///< seeds of the outcomes that failed, rising
  Wins wins;                          ///< no pairs for the baseline itself
};

struct MethodSummary {
  std::string method;
  bool needs_truth = false;  ///< as registered: not to be had on a real robot
  std::int64_t outcomes = 0, not_ok = 0;
  Interval not_ok_share{};                         ///< Clopper and Pearson, 95 %
  std::vector<std::uint64_t> seeds, not_ok_seeds;  ///< of all outcomes, and of those that failed; rising
  std::map<std::string, MetricSummary> metrics;
  std::string what;  ///< one sentence and the source, as registered; "" of a method out of a file
  const MetricSummary* find(const std::string& metric) const;
};

/// All methods of one kind on one scenario.
struct Section {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string baseline;  ///< what the others are paired with: the method that does nothing about the problem
  std::vector<MethodSummary> methods;  ///< in the order of the registry
  std::vector<std::string> metrics;    ///< in the order of the registry, then by name
  const MethodSummary* find(const std::string& method) const;
};

struct Summary {
  std::vector<Section> sections;  ///< by scenario, then by kind
  std::vector<std::string> scenarios;
  std::map<std::string, std::int64_t> draws, rejected;  ///< per scenario
};

/// The value of one draw, or the worst in its place.
struct RankedValue {
  std::uint64_t seed;
  double value;
};

/// Values and failures by rising seed; where there is no worst (NaN) the failures have none.
std::vector<RankedValue> ranked_values(const MetricSummary& metric, double worst);

/// O(number of scores * log).
Summary summarize(const Results& results);
/// The same, which hands each plain outcome on as it is read, for who would read them all once more.
Summary summarize(const Results& results, Names& names, const std::function<void(const OutcomeView&)>& beside);

}  // namespace tumble::scenarios
