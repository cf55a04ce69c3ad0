// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

namespace {

/// Position in the registry; unknown names stand behind the known ones.
std::size_t metric_rank(const std::string& name) {
  const auto all = metrics();
  return static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const Metric& m) { return m.info.name == name; }) - all.begin());
}

const MethodInfo* registered(Kind kind, const std::string& name) {
  const std::size_t rank = method_rank(kind, name);
  return rank < methods().size() ? &methods()[rank].info : nullptr;
}

/// The one that is registered as baseline where there is one; else the first of the registry that needs no truth.
std::string choose_baseline(Kind kind, const std::vector<MethodSummary>& methods) {
  for (const MethodSummary& method : methods) {
    const MethodInfo* info = registered(kind, method.method);
    if (info != nullptr && info->baseline) return method.method;
  }
  for (const MethodSummary& method : methods) {
    if (!method.needs_truth) return method.method;
  }
  return methods.front().method;
}

/// Compares draw by draw; where both failed neither is better.
Wins paired_wins(const MetricSummary& own, const MetricSummary& base, const MetricInfo& info) {
  Wins wins;
  if (info.sense == Sense::none) return wins;
  const std::vector<RankedValue> others = ranked_values(base, worst_value(info));
  auto other = others.begin();
  for (const RankedValue& each : ranked_values(own, worst_value(info))) {
    while (other != others.end() && other->seed < each.seed) ++other;
    if (other == others.end() || other->seed != each.seed) continue;
    wins.count += is_better(info, each.value, other->value) ? 1 : 0;
    ++wins.pairs;
  }
  return wins;
}

void finish(const std::string& name, MetricSummary& metric) {
  const MetricInfo& info = metric_info(name);
  const std::vector<double> ranked = with_failures(metric.values, metric.failed.size(), worst_value(info));
  if (info.unit == Unit::verdict) {
    const auto count = std::count_if(ranked.begin(), ranked.end(), [](double v) { return v != 0.0; });
    metric.centre = share_interval(count, static_cast<std::int64_t>(ranked.size()));
  } else {
    metric.centre = median_interval(ranked);
  }
  metric.quantile_95 = quantile(ranked, info.sense == Sense::higher ? 0.05 : 0.95);
}

/// Gives each failed outcome its place in every metric that some method has a value of on that draw.
void place_failures(Section& section, const std::map<std::string, std::set<std::uint64_t>>& failed_seeds) {
  std::map<std::string, std::set<std::uint64_t>> scored;
  for (const MethodSummary& method : section.methods) {
    for (const auto& [name, metric] : method.metrics) scored[name].insert(metric.seeds.begin(), metric.seeds.end());
  }
  for (MethodSummary& method : section.methods) {
    const auto failed = failed_seeds.find(method.method);
    if (failed == failed_seeds.end()) continue;
    for (const auto& [name, seeds] : scored) {
      for (const std::uint64_t seed : failed->second) {
        if (seeds.contains(seed)) method.metrics[name].failed.push_back(seed);
      }
    }
  }
}

void finish(Section& section) {
  std::stable_sort(section.methods.begin(), section.methods.end(), [&](const MethodSummary& a, const MethodSummary& b) {
    return method_rank(section.kind, a.method) < method_rank(section.kind, b.method);
  });
  std::set<std::string> names;
  for (MethodSummary& method : section.methods) {
    const MethodInfo* info = registered(section.kind, method.method);
    method.needs_truth = info != nullptr && info->needs_truth;
    std::sort(method.seeds.begin(), method.seeds.end());
    std::sort(method.not_ok_seeds.begin(), method.not_ok_seeds.end());
    method.not_ok_share = share_interval(method.not_ok, method.outcomes);
    for (auto& [name, metric] : method.metrics) {
      finish(name, metric);
      if (!parse_binned(name)) names.insert(name);  // those are drawn as curves
    }
  }
  section.metrics.assign(names.begin(), names.end());
  std::stable_sort(section.metrics.begin(), section.metrics.end(),
                   [](const std::string& a, const std::string& b) { return metric_rank(a) < metric_rank(b); });
  section.baseline = choose_baseline(section.kind, section.methods);
  const MethodSummary& base = *section.find(section.baseline);
  for (MethodSummary& method : section.methods) {
    if (method.method == section.baseline) continue;
    for (auto& [name, metric] : method.metrics) {
      const MetricSummary* other = base.find(name);
      if (other != nullptr) metric.wins = paired_wins(metric, *other, metric_info(name));
    }
  }
}

}  // namespace

std::size_t method_rank(Kind kind, const std::string& name) {
  const auto all = methods();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Method& m) { return m.info.kind == kind && m.info.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}

std::vector<RankedValue> ranked_values(const MetricSummary& metric, double worst) {
  std::vector<RankedValue> out;
  out.reserve(metric.seeds.size() + metric.failed.size());
  auto failed = std::isnan(worst) ? metric.failed.end() : metric.failed.begin();
  for (std::size_t i = 0; i < metric.seeds.size(); ++i) {
    for (; failed != metric.failed.end() && *failed < metric.seeds[i]; ++failed) out.push_back({*failed, worst});
    out.push_back({metric.seeds[i], metric.values[i]});
  }
  for (; failed != metric.failed.end(); ++failed) out.push_back({*failed, worst});
  return out;
}

const MetricSummary* MethodSummary::find(const std::string& metric) const {
  const auto found = metrics.find(metric);
  return found == metrics.end() ? nullptr : &found->second;
}

const MethodSummary* Section::find(const std::string& method) const {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const MethodSummary& m) { return m.method == method; });
  return found == methods.end() ? nullptr : &*found;
}

Summary summarize(const Results& results) {
  std::map<std::pair<std::string, Kind>, Section> sections;
  std::map<std::string, std::set<std::uint64_t>> seeds;
  const auto method_of = [&](const std::string& scenario, Kind kind, const std::string& name) -> MethodSummary& {
    Section& section = sections[{scenario, kind}];
    section.scenario = scenario;
    section.kind = kind;
    for (MethodSummary& method : section.methods) {
      if (method.method == name) return method;
    }
    section.methods.push_back({});
    section.methods.back().method = name;
    return section.methods.back();
  };
  std::map<std::pair<std::string, Kind>, std::map<std::string, std::set<std::uint64_t>>> failed_seeds;
  for (const Outcome& outcome : results.outcomes()) {
    MethodSummary& method = method_of(outcome.scenario, outcome.kind, outcome.method);
    ++method.outcomes;
    method.seeds.push_back(outcome.seed);
    if (outcome.status != OutcomeStatus::ok) {
      ++method.not_ok;
      method.not_ok_seeds.push_back(outcome.seed);
      failed_seeds[{outcome.scenario, outcome.kind}][outcome.method].insert(outcome.seed);
    }
    seeds[outcome.scenario].insert(outcome.seed);
  }
  // values by rising seed, whatever the order in the database
  std::vector<ScoreRow> rows = results.scores();
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.seed < b.seed; });
  for (const ScoreRow& row : rows) {
    if (row.status != OutcomeStatus::ok || !std::isfinite(row.value)) continue;
    for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
      if (row.kind != to_string(kind)) continue;
      MetricSummary& metric = method_of(row.scenario, kind, row.method).metrics[row.metric];
      metric.seeds.push_back(row.seed);
      metric.values.push_back(row.value);
    }
  }
  Summary summary;
  for (auto& [key, section] : sections) {
    place_failures(section, failed_seeds[key]);
    finish(section);
    summary.sections.push_back(std::move(section));
  }
  for (const RejectedDraw& draw : results.rejected()) {
    ++summary.rejected[draw.scenario];
    seeds[draw.scenario];
  }
  for (const auto& [scenario, own] : seeds) {
    summary.scenarios.push_back(scenario);
    summary.draws[scenario] = static_cast<std::int64_t>(own.size());
  }
  return summary;
}

}  // namespace tumble::scenarios
