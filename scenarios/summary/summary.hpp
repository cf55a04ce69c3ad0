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

/// Returns the display style of a metric.
inline MetricStyle metric_style(const std::string& metric) {
  return style_of(metric_info(metric).unit);
}

/// Returns the position of a method in the list of registered methods. Unknown methods come last.
std::size_t method_rank(Kind kind, const std::string& name);

/// Wins counts the simulated runs on which one method was better than the baseline, among the runs on which both
/// methods have values.
struct Wins {
  std::int64_t count = 0, pairs = 0;
};

/// MetricSummary summarises one metric of one method over all simulated runs of a scenario. Only outcomes with the
/// status `ok` have values. Failed outcomes rank worst in all statistics, so the median is infinite if half of the runs
/// fail. Simulated runs for which no method has a value do not count.
struct MetricSummary {
  Interval centre{};  ///< median, or share for a verdict; with the 95 % interval
  double quantile_95 = 0.0;
  std::vector<std::uint64_t> seeds;   ///< ascending
  std::vector<double> values;         ///< parallel to `seeds`
  std::vector<std::uint64_t> failed;  ///< seeds of failed outcomes, ascending
  Wins wins;                          ///< no pairs for the baseline itself
};

struct MethodSummary {
  std::string method;
  bool needs_truth = false;  ///< as registered; oracles are not available on a real robot
  std::int64_t outcomes = 0, not_ok = 0;
  Interval not_ok_share{};                         ///< Clopper and Pearson, 95 %
  std::vector<std::uint64_t> seeds, not_ok_seeds;  ///< of all outcomes, and of failed ones; ascending
  std::map<std::string, MetricSummary> metrics;
  std::string what;  ///< description and source, as registered; "" for an external method
  const MetricSummary* find(const std::string& metric) const;
};

/// Section contains all methods of one kind on one scenario.
struct Section {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string baseline;                ///< reference for the paired comparisons: the method without a treatment
  std::vector<MethodSummary> methods;  ///< in the order of the registry
  std::vector<std::string> metrics;    ///< in the order of the registry, then by name
  const MethodSummary* find(const std::string& method) const;
};

struct Summary {
  std::vector<Section> sections;  ///< by scenario, then by kind
  std::vector<std::string> scenarios;
  std::map<std::string, std::int64_t> draws, rejected;  ///< per scenario
};

/// RankedValue is the value of a metric on one simulated run; a failed run has the worst value.
struct RankedValue {
  std::uint64_t seed;
  double value;
};

/// Returns the values and failures of a metric, by ascending seed. If `worst` is NaN, failures are omitted.
std::vector<RankedValue> ranked_values(const MetricSummary& metric, double worst);

/// Computes statistics of all metrics in the results, in O(number of scores * log).
Summary summarize(const Results& results);
/// Computes statistics of all metrics in the results. The function also calls `beside` with each unmodified outcome,
/// which avoids a second pass over the results.
Summary summarize(const Results& results, Names& names, const std::function<void(const OutcomeView&)>& beside);

}  // namespace tumble::scenarios
