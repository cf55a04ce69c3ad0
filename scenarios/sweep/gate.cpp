// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/statistics/paired.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

bool by_difference(const MetricInfo& info) {
  return info.compared == Compared::by_difference;
}

double margin_of(const MetricInfo& info, const GatePolicy& policy) {
  if (!by_difference(info)) return std::log1p(policy.margin);
  return info.unit == Unit::time_offset ? policy.time_margin_s : policy.share_margin;
}

double difference(const MetricInfo& info, double before, double now) {
  if (before == now) return 0.0;
  if (by_difference(info)) return now - before;
  if (before <= 0.0) return kInfinity;
  if (now <= 0.0) return -kInfinity;
  return std::log(now / before);
}

double badness(const MetricInfo& info, double value) {
  if (!by_difference(info)) return value;
  return info.unit == Unit::share ? 1.0 - value : std::abs(value - info.target);
}

struct GatePair {
  std::uint64_t seed = 0;
  double before = 0.0, now = 0.0;  ///< infinite if not ok
};

struct GatePairs {
  std::vector<GatePair> pairs;
  std::vector<std::uint64_t> lost;
};

double value_at(const MethodRun& run, const std::string& metric, std::size_t draw) {
  const auto values = run.values.find(metric);
  return values == run.values.end() ? kNaN : values->second[draw];
}

GatePairs pairs_of(const GateRun& all, const MethodRun& before, const MethodRun& now, const MetricInfo& info) {
  GatePairs out;
  for (std::size_t k = 0; k < all.seeds.size(); ++k) {
    const bool was_ok = before.status[k] == OutcomeStatus::ok, is_ok = now.status[k] == OutcomeStatus::ok;
    GatePair pair{all.seeds[k], value_at(before, info.name, k), value_at(now, info.name, k)};
    if (was_ok && std::isnan(pair.before)) continue;
    if (was_ok && is_ok && std::isnan(pair.now)) out.lost.push_back(pair.seed);
    if (!was_ok) pair.before = worst_value(info);
    if (!is_ok) pair.now = worst_value(info);
    if (!std::isnan(pair.before) && !std::isnan(pair.now)) out.pairs.push_back(pair);
  }
  return out;
}

double chance_beyond(std::vector<double> differences, double margin) {
  for (double& each : differences) each -= margin;
  return signed_rank_chance(differences);
}

void hold_worst_draw(const MetricInfo& info, const std::vector<GatePair>& pairs, const GatePolicy& policy,
                     GateResult& result) {
  if (pairs.empty()) return;
  const auto worse = [&](double GatePair::*member) {
    return [&info, member](const GatePair& a, const GatePair& b) {
      return badness(info, a.*member) < badness(info, b.*member);
    };
  };
  const GatePair& before = *std::max_element(pairs.begin(), pairs.end(), worse(&GatePair::before));
  const GatePair& now = *std::max_element(pairs.begin(), pairs.end(), worse(&GatePair::now));
  const double slack = by_difference(info) ? margin_of(info, policy) : 0.0;
  if (!(badness(info, now.now) > policy.worst * badness(info, before.before) + slack)) return;
  result.seed = now.seed;
  result.fault = fmt::format("the worst value is {} (seed {}), but the worst value of the accepted results is {}",
                             rounded(now.now), now.seed, rounded(before.before));
}

/// For a two-sided metric, the p-value is twice the smaller of the two one-sided p-values, so that each metric counts
/// as one statistical test.
void hold_middle(const std::vector<GatePair>& pairs, const MetricInfo& info, const GatePolicy& policy,
                 std::size_t tests, GateResult& result) {
  result.draws = pairs.size();
  result.accepted = median_of(pairs, &GatePair::before);
  result.value = median_of(pairs, &GatePair::now);
  std::vector<double> more, less;
  for (const GatePair& pair : pairs) {
    more.push_back(difference(info, pair.before, pair.now));
    less.push_back(-more.back());
  }
  const double middle = quantile(more, 0.5);
  result.change = by_difference(info) ? middle : std::expm1(middle);
  const double margin = margin_of(info, policy);
  const double rises = chance_beyond(more, margin), falls = chance_beyond(less, margin);
  double worse = 1.0, better = 1.0;
  if (info.sense == Sense::lower) worse = rises, better = falls;
  if (info.sense == Sense::higher) worse = falls, better = rises;
  if (info.sense == Sense::two_sided) worse = 2.0 * std::min(rises, falls);
  const auto corrected = [&](double chance) { return std::min(1.0, chance * static_cast<double>(tests)); };
  result.chance = corrected(worse);
  result.better = corrected(better) < policy.risk;
  if (!(result.chance < policy.risk)) return;
  const auto count = std::count_if(more.begin(), more.end(), [&](double d) { return rises < falls ? d > 0 : d < 0; });
  result.fault = (info.sense == Sense::two_sided ? (rises < falls ? "higher in " : "lower in ") : "worse in ") +
                 std::to_string(count) + " of " + std::to_string(pairs.size());
}

GateResult hold_metric(const GatePairs& found, const MethodRun& before, const MetricInfo& info,
                       const GatePolicy& policy, std::size_t tests) {
  GateResult result{before.scenario, before.kind, before.method, info.name};
  hold_middle(found.pairs, info, policy, tests, result);
  if (!found.lost.empty()) {
    result.seed = found.lost.front();
    result.fault = fmt::format("the metric has a value in the accepted results, but no value in this run at seed {}",
                               found.lost.front());
    if (found.lost.size() > 1) result.fault += " and " + std::to_string(found.lost.size() - 1) + " more";
  } else if (result.passes()) {
    hold_worst_draw(info, found.pairs, policy, result);
  }
  return result;
}

bool is_condemned(const MethodRun& run, const MetricInfo& verdict, std::size_t draw) {
  return value_at(run, verdict.name, draw) > 0.0;
}

GateResult hold_outcomes(const GateRun& all, const MethodRun& before, const MethodRun& now,
                         std::span<const MetricInfo* const> verdicts) {
  GateResult result{before.scenario, before.kind, before.method, ""};
  std::size_t was = 0, is = 0;
  for (std::size_t k = 0; k < all.seeds.size(); ++k) {
    const std::string seed = " at seed " + std::to_string(all.seeds[k]);
    const auto condemned = [&](const MethodRun& run) {
      const auto found = std::find_if(verdicts.begin(), verdicts.end(),
                                      [&](const MetricInfo* verdict) { return is_condemned(run, *verdict, k); });
      return found == verdicts.end() ? std::string() : (*found)->name;
    };
    const bool was_good = before.status[k] == OutcomeStatus::ok && condemned(before).empty();
    std::string fault;
    if (!now.status[k])
      fault = "no result";
    else if (*now.status[k] != OutcomeStatus::ok)
      fault = to_string(*now.status[k]);
    else
      fault = condemned(now);
    was += was_good ? 0 : 1;
    is += fault.empty() ? 0 : 1;
    if (result.fault.empty() && !fault.empty() && (was_good || !now.status[k])) {
      result.fault = fault + seed;
      result.seed = all.seeds[k];
    }
  }
  result.draws = all.seeds.size();
  result.accepted = static_cast<double>(was) / static_cast<double>(all.seeds.size());
  result.value = static_cast<double>(is) / static_cast<double>(all.seeds.size());
  result.change = result.value - result.accepted;
  result.better = result.fault.empty() && is < was;
  return result;
}

MethodRun without_outcomes(const MethodRun& like) {
  MethodRun none = like;
  none.values.clear();
  std::fill(none.status.begin(), none.status.end(), std::nullopt);
  return none;
}

struct Pooled {
  Kind kind = Kind::rate;
  std::string method;
  const MetricInfo* info = nullptr;
  std::vector<GatePair> pairs = {};
  bool is_of(const MethodRun& run, const MetricInfo& metric) const {
    return run.kind == kind && run.method == method && &metric == info;
  }
};

std::vector<Pooled> pooled_metrics(const GateRun& accepted) {
  std::vector<Pooled> seen, out;
  const auto has = [](const std::vector<Pooled>& list, const MethodRun& run, const MetricInfo& info) {
    return std::any_of(list.begin(), list.end(), [&](const Pooled& each) { return each.is_of(run, info); });
  };
  for (const MethodRun& run : accepted.methods) {
    for (const auto& [name, values] : run.values) {
      const MetricInfo& info = metric_info(name);
      if (info.unit == Unit::verdict || has(out, run, info)) continue;
      (has(seen, run, info) ? out : seen).push_back({run.kind, run.method, &info});
    }
  }
  return out;
}

}  // namespace

const MethodRun* GateRun::find(const std::string& scenario, Kind kind, const std::string& method) const {
  const auto found = std::find_if(methods.begin(), methods.end(), [&](const MethodRun& run) {
    return run.scenario == scenario && run.kind == kind && run.method == method;
  });
  return found == methods.end() ? nullptr : &*found;
}

std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate) {
  if (gate.accepted.methods.empty())
    throw BadInput(fmt::format(
        "suite {} has no accepted results; 'tumble gate SUITE --accept' creates accepted results", gate.suite));
  if (run.seeds != gate.accepted.seeds) {
    throw BadInput(
        fmt::format("the accepted results of suite {} have other seeds ({} simulated runs) than this comparison ({} "
                    "simulated runs). Use the same seeds, or run 'tumble gate {} --accept' to accept the new results",
                    gate.suite, gate.accepted.seeds.size(), run.seeds.size(), gate.suite));
  }
  std::vector<Pooled> all = pooled_metrics(gate.accepted);
  std::size_t tests = all.size();
  for (const MethodRun& before : gate.accepted.methods) tests += before.values.size();
  std::vector<GateResult> held;
  for (const MethodRun& before : gate.accepted.methods) {
    const MethodRun* found = run.find(before.scenario, before.kind, before.method);
    const MethodRun now = found == nullptr ? without_outcomes(before) : *found;
    std::vector<const MetricInfo*> verdicts, metrics;
    for (const auto& [name, values] : before.values) {
      const MetricInfo& info = metric_info(name);
      (info.unit == Unit::verdict ? verdicts : metrics).push_back(&info);
    }
    held.push_back(hold_outcomes(run, before, now, verdicts));
    for (const MetricInfo* info : metrics) {
      const GatePairs found_pairs = pairs_of(run, before, now, *info);
      held.push_back(hold_metric(found_pairs, before, *info, gate.policy, tests));
      for (Pooled& pooled : all) {
        if (pooled.is_of(before, *info))
          pooled.pairs.insert(pooled.pairs.end(), found_pairs.pairs.begin(), found_pairs.pairs.end());
      }
    }
  }
  for (const Pooled& pooled : all) {
    GateResult result{"", pooled.kind, pooled.method, pooled.info->name};
    hold_middle(pooled.pairs, *pooled.info, gate.policy, tests, result);
    held.push_back(std::move(result));
  }
  return held;
}

void require_acceptable(const GateRun& run) {
  if (run.methods.empty()) throw BadInput("this run cannot be accepted, because it has no results");
  for (const MethodRun& method : run.methods) {
    const std::string what =
        "cannot accept this run: " + method.scenario + ", " + to_string(method.kind) + "/" + method.method;
    for (std::size_t k = 0; k < run.seeds.size(); ++k) {
      if (!method.status[k]) throw BadInput(fmt::format("{} has no result at seed {}", what, run.seeds[k]));
    }
    if (std::find(method.status.begin(), method.status.end(), OutcomeStatus::ok) == method.status.end()) {
      throw BadInput(fmt::format("{} has no result with status ok", what));
    }
  }
}

}  // namespace tumble::scenarios
