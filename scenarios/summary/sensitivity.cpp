// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/statistics/paired.hpp"
#include "scenarios/summary/selection.hpp"

namespace tumble::scenarios {

namespace {

struct Scored {
  std::vector<std::uint64_t> seeds;
  std::vector<double> values, badness;
  Centre centre = Centre::median;  ///< statistic of the partial dependence
};

Scored scored(const MetricSummary& metric, const MetricInfo& info) {
  Scored out;
  if (info.unit == Unit::verdict) out.centre = Centre::share;
  for (const RankedValue& each : ranked_values(metric, worst_value(info))) {
    out.seeds.push_back(each.seed);
    out.values.push_back(info.unit == Unit::verdict && each.value != 0.0 ? 1.0 : each.value);
    const bool contested = info.sense != Sense::none;
    out.badness.push_back(contested ? how_bad(info, each.value) : each.value);
  }
  return out;
}

Scored failures(const MethodSummary& method) {
  Scored out{method.seeds, {}, {}, Centre::share};
  for (const std::uint64_t seed : method.seeds) {
    const bool failed = std::binary_search(method.not_ok_seeds.begin(), method.not_ok_seeds.end(), seed);
    out.values.push_back(failed ? 1.0 : 0.0);
  }
  out.badness = out.values;
  return out;
}

void add_quarters(const std::vector<double>& numbers, const std::vector<double>& values, Influence& out) {
  const double low = quantile(numbers, 0.25), high = quantile(numbers, 0.75);
  std::vector<double> lowest, highest;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] <= low) lowest.push_back(values[i]);
    if (numbers[i] >= high) highest.push_back(values[i]);
  }
  out.median_low = quantile(lowest, 0.5);
  out.median_high = quantile(highest, 0.5);
}

std::vector<double> at_seeds(const std::vector<RankedValue>& numbers, const std::vector<std::uint64_t>& seeds) {
  std::vector<double> column;
  column.reserve(seeds.size());
  auto at = numbers.begin();
  for (const std::uint64_t seed : seeds) {
    while (at != numbers.end() && at->seed < seed) ++at;
    column.push_back(at != numbers.end() && at->seed == seed ? at->value : std::nan(""));
  }
  return column;
}

std::vector<Influence> influences(const Scored& scored, const NumbersOfDraws& numbers) {
  std::vector<Influence> out;
  std::vector<double> chances;
  const std::vector<double> ranks = mean_ranks(scored.badness);
  for (const auto& [name, by_seed] : numbers) {
    const std::vector<double> column = at_seeds(by_seed, scored.seeds);
    Influence each{name, rank_correlation(column, ranks), first_order_index(column, ranks)};
    add_quarters(column, scored.values, each);
    each.dependence = partial_dependence(column, scored.values, scored.centre);
    // The p-value combines the test of the rank correlation and the test of the first-order index, equation (S21) of
    // statistics.md.
    chances.push_back(std::min(1.0, 2.0 * std::min(each.correlation.chance, each.first_order.chance)));
    out.push_back(std::move(each));
  }
  chances = holm(chances);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].corrected = chances[i];
  std::stable_sort(out.begin(), out.end(),
                   [](const Influence& a, const Influence& b) { return a.strength() > b.strength(); });
  return out;
}

bool has_both(const Scored& failures) {
  const auto failed = static_cast<std::size_t>(std::count(failures.values.begin(), failures.values.end(), 1.0));
  return failed >= kSensitivityFailuresMin && failures.values.size() - failed >= kSensitivityFailuresMin;
}

}  // namespace

double Influence::strength() const {
  return std::max(first_order.index, correlation.rho * correlation.rho);
}

NumbersOfDraws numbers_of_draws(const Summary& summary, const Scenario& scenario) {
  std::set<std::uint64_t> seeds;
  for (const Section& section : summary.sections) {
    if (section.scenario != scenario.name) continue;
    for (const MethodSummary& method : section.methods) seeds.insert(method.seeds.begin(), method.seeds.end());
  }
  NumbersOfDraws out;
  for (const DrawnNumber& number : drawn_numbers(scenario)) {
    std::vector<RankedValue>& column = out[number.place];
    for (const std::uint64_t seed : seeds) column.push_back({seed, number.of(seed)});
  }
  return out;
}

NumbersOfDraws numbers_of_motion(std::span<const DrawValues> draws, const std::string& scenario) {
  NumbersOfDraws out;
  for (const DrawValues& draw : draws) {
    if (draw.scenario != scenario || !draw.setting.is_plain()) continue;
    for (const Score& value : draw.values) out[value.metric].push_back({draw.seed, value.value});
  }
  for (auto& [name, column] : out) {
    std::sort(column.begin(), column.end(), [](const auto& a, const auto& b) { return a.seed < b.seed; });
  }
  return out;
}

std::vector<Sensitivity> sensitivities(const Summary& summary, const std::map<std::string, NumbersOfDraws>& numbers,
                                       const SensitivityOptions& options) {
  require_held(summary, options.methods, options.metrics);
  std::vector<Sensitivity> out;
  for (const Section& section : summary.sections) {
    const auto own = numbers.find(section.scenario);
    if (own == numbers.end() || own->second.empty()) continue;
    for (const MethodSummary& method : section.methods) {
      if (!is_selected(options.methods, section.kind, method)) continue;
      const auto add = [&](const std::string& metric, const Scored& values) {
        if (values.seeds.size() < kSensitivityDrawsMin) return;
        out.push_back({section.scenario, section.kind, method.method, metric, values.seeds.size(),
                       influences(values, own->second)});
      };
      if (const Scored failed = failures(method); has_both(failed)) add("not ok", failed);
      for (const std::string& name : options.metrics.empty() ? headline_metrics(section.kind) : options.metrics) {
        if (const MetricSummary* metric = method.find(name)) add(name, scored(*metric, metric_info(name)));
      }
    }
  }
  return out;
}

}  // namespace tumble::scenarios
