// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

namespace {

std::size_t metric_rank(const std::string& name) {
  const auto all = metrics();
  return static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const Metric& m) { return m.info.name == name; }) - all.begin());
}

const MethodInfo* registered(Kind kind, const std::string& name) {
  const std::size_t rank = method_rank(kind, name);
  return rank < methods().size() ? &methods()[rank].info : nullptr;
}

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

void place_failures(Section& section) {
  std::set<std::string> names;
  for (const MethodSummary& method : section.methods) {
    for (const auto& [name, metric] : method.metrics) names.insert(name);
  }
  for (const std::string& name : names) {
    std::vector<const MetricSummary*> scored;
    for (const MethodSummary& method : section.methods) {
      if (const MetricSummary* metric = method.find(name)) scored.push_back(metric);
    }
    for (MethodSummary& method : section.methods) {
      std::vector<std::uint64_t> failed;
      std::copy_if(method.not_ok_seeds.begin(), method.not_ok_seeds.end(), std::back_inserter(failed),
                   [&](std::uint64_t seed) {
                     return std::any_of(scored.begin(), scored.end(), [&](const MetricSummary* metric) {
                       return std::binary_search(metric->seeds.begin(), metric->seeds.end(), seed);
                     });
                   });
      if (!failed.empty()) method.metrics[name].failed = std::move(failed);
    }
  }
}

void sort_by_seed(MetricSummary& metric) {
  if (std::is_sorted(metric.seeds.begin(), metric.seeds.end())) return;
  std::vector<RankedValue> sorted = ranked_values(metric, std::nan(""));
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.seed < b.seed; });
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    metric.seeds[i] = sorted[i].seed;
    metric.values[i] = sorted[i].value;
  }
}

struct Gathered {
  MethodSummary summary;
  std::unordered_map<const std::string*, MetricSummary*> places;

  void add(const OutcomeView& outcome) {
    ++summary.outcomes;
    summary.seeds.push_back(outcome.seed);
    if (outcome.status != OutcomeStatus::ok) {
      ++summary.not_ok;
      summary.not_ok_seeds.push_back(outcome.seed);
      return;
    }
    for (const OutcomeView::Value& score : outcome.scores) {
      if (!std::isfinite(score.value)) continue;
      MetricSummary*& place = places[score.metric];
      if (place == nullptr) place = &summary.metrics[*score.metric];
      place->seeds.push_back(outcome.seed);
      place->values.push_back(score.value);
    }
  }

  MethodSummary sorted() {
    for (std::vector<std::uint64_t>* seeds : {&summary.seeds, &summary.not_ok_seeds}) {
      if (!std::is_sorted(seeds->begin(), seeds->end())) std::sort(seeds->begin(), seeds->end());
    }
    for (auto& [name, metric] : summary.metrics) sort_by_seed(metric);
    return std::move(summary);
  }
};

using GatheredSections = std::map<std::pair<std::string, Kind>, std::map<std::string, Gathered, std::less<>>>;

GatheredSections gather(const Results& results, Names& names, const std::function<void(const OutcomeView&)>& beside) {
  GatheredSections sections;
  results.each(Rows::plain, names, [&](const OutcomeView& outcome) {
    auto& methods = sections[{std::string(outcome.scenario), outcome.kind}];
    auto method = methods.find(outcome.method);
    if (method == methods.end()) {
      method = methods.emplace(outcome.method, Gathered{}).first;
      method->second.summary.method = outcome.method;
    }
    method->second.add(outcome);
    beside(outcome);
  });
  return sections;
}

void finish(Section& section) {
  std::stable_sort(section.methods.begin(), section.methods.end(), [&](const MethodSummary& a, const MethodSummary& b) {
    return method_rank(section.kind, a.method) < method_rank(section.kind, b.method);
  });
  std::set<std::string> names;
  for (MethodSummary& method : section.methods) {
    const MethodInfo* info = registered(section.kind, method.method);
    method.needs_truth = info != nullptr && info->needs_truth;
    if (info != nullptr) method.what = info->doc + " Source: " + info->source + ".";
    method.not_ok_share = share_interval(method.not_ok, method.outcomes);
    for (auto& [name, metric] : method.metrics) {
      finish(name, metric);
      if (!parse_binned(name)) names.insert(name);  // binned metrics appear only in curves
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
  Names names;
  return summarize(results, names, [](const OutcomeView&) {});
}

Summary summarize(const Results& results, Names& names, const std::function<void(const OutcomeView&)>& beside) {
  Summary summary;
  std::map<std::string, std::vector<std::uint64_t>> seeds;
  for (auto& [key, methods] : gather(results, names, beside)) {
    Section section;
    std::tie(section.scenario, section.kind) = key;
    std::vector<std::uint64_t>& own = seeds[section.scenario];
    for (auto& [name, gathered] : methods) {
      section.methods.push_back(gathered.sorted());
      const std::vector<std::uint64_t>& more = section.methods.back().seeds;
      std::vector<std::uint64_t> all;
      std::set_union(own.begin(), own.end(), more.begin(), more.end(), std::back_inserter(all));
      own = std::move(all);
    }
    place_failures(section);
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
