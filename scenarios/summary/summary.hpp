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

inline MetricStyle metric_style(const std::string& metric) {
  return style_of(metric_info(metric).unit);
}

std::size_t method_rank(Kind kind, const std::string& name);

struct Wins {
  std::int64_t count = 0, pairs = 0;
};

/// MetricSummary contains statistics of one metric. Failed runs count as the worst values, so the median is infinite if
/// half of the runs fail.
struct MetricSummary {
  Interval centre{};  ///< median or fraction, 95 % interval
  double quantile_95 = 0.0;
  std::vector<std::uint64_t> seeds;   ///< ascending
  std::vector<double> values;         ///< parallel to `seeds`
  std::vector<std::uint64_t> failed;  ///< seeds of failed outcomes, ascending
  Wins wins;                          ///< against the reference method
};

struct MethodSummary {
  std::string method;
  bool needs_truth = false;  ///< true for an oracle
  std::int64_t outcomes = 0, not_ok = 0;
  Interval not_ok_share{};                         ///< Clopper and Pearson, 95 %
  std::vector<std::uint64_t> seeds, not_ok_seeds;  ///< seeds of all and of failed outcomes; ascending
  std::map<std::string, MetricSummary> metrics;
  std::string what;  ///< empty for an external method
  const MetricSummary* find(const std::string& metric) const;
};

struct Section {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string baseline;                ///< reference method
  std::vector<MethodSummary> methods;  ///< in the order of the registry
  std::vector<std::string> metrics;    ///< in the order of the registry, then by name
  const MethodSummary* find(const std::string& method) const;
};

struct Summary {
  std::vector<Section> sections;  ///< by scenario, then by kind
  std::vector<std::string> scenarios;
  std::map<std::string, std::int64_t> draws, rejected;  ///< numbers of runs per scenario
};

struct RankedValue {
  std::uint64_t seed;
  double value;
};

std::vector<RankedValue> ranked_values(const MetricSummary& metric, double worst);

Summary summarize(const Results& results);
Summary summarize(const Results& results, Names& names, const std::function<void(const OutcomeView&)>& beside);

}  // namespace tumble::scenarios
