// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/input_worth.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scenarios/not_finite.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/statistics/bootstrap.hpp"
#include "scenarios/statistics/paired.hpp"

namespace tumble::scenarios {

namespace {

double badness(const MetricInfo& info, const Outcome& outcome) {
  if (outcome.status != OutcomeStatus::ok) return how_bad(info, worst_value(info));
  const Score* const score = find_score(outcome.scores, info.name);
  return score != nullptr ? how_bad(info, score->value) : kNaN;
}

double improvement(double before, double now) {
  return before == now ? 0.0 : before - now;
}

struct InputPairs {
  InputWorth worth;
  std::vector<double> improvements;
};

void add(const MetricInfo& info, const TriageRow& before, const TriageRow& now, InputPairs& pairs) {
  InputWorth& worth = pairs.worth;
  worth.input = now.input;
  worth.doc = now.doc;
  ++worth.draws;
  worth.failed += before.fails ? 1 : 0;
  worth.cured += before.fails && !now.fails ? 1 : 0;
  worth.broken += !before.fails && now.fails ? 1 : 0;
  const double gained = improvement(badness(info, before.outcome), badness(info, now.outcome));
  if (std::isnan(gained)) return;
  worth.better += gained > 0.0 ? 1 : 0;
  worth.worse += gained < 0.0 ? 1 : 0;
  pairs.improvements.push_back(gained);
}

InputWorth concluded(InputPairs pairs) {
  InputWorth& worth = pairs.worth;
  worth.cured_share = worth.failed == 0 ? Interval{kNaN, kNaN, kNaN} : share_interval(worth.cured, worth.failed);
  worth.improvement = {kNaN, kNaN, kNaN};
  if (pairs.improvements.empty()) return worth;
  worth.improvement = MedianBootstrap(pairs.improvements.size()).interval(pairs.improvements);
  worth.chance = signed_rank_test(pairs.improvements);
  return worth;
}

bool matters_more(const InputWorth& a, const InputWorth& b) {
  const auto share = [](const InputWorth& worth) {
    return std::isnan(worth.cured_share.value) ? 0.0 : worth.cured_share.value;
  };
  if (share(a) != share(b)) return share(a) > share(b);
  const auto helps = [](const InputWorth& worth) { return worth.better > worth.worse; };
  if (helps(a) != helps(b)) return helps(a);
  return a.chance < b.chance;
}

std::vector<InputWorth> worth_within(std::span<const DrawTriage> draws, const MetricInfo& info,
                                     const std::string& scenario) {
  std::map<std::string, InputPairs> inputs;
  for (const DrawTriage& draw : draws) {
    if (draw.rows.empty() || !(scenario.empty() || draw.draw.scenario == scenario)) continue;
    const std::span<const TriageRow> replaced = std::span(draw.rows).subspan(1);
    for (const TriageRow& row : replaced) add(info, draw.rows.front(), row, inputs[row.input]);
  }
  std::vector<InputWorth> out;
  for (auto& [input, pairs] : inputs) {
    pairs.worth.scenario = scenario;
    out.push_back(concluded(std::move(pairs)));
  }
  std::stable_sort(out.begin(), out.end(), matters_more);
  return out;
}

}  // namespace

std::vector<InputWorth> worth_of_inputs(std::span<const DrawTriage> draws, const std::string& metric) {
  const MetricInfo& info = metric_info(metric);
  std::set<std::string> scenarios;
  for (const DrawTriage& draw : draws) scenarios.insert(draw.draw.scenario);
  std::vector<InputWorth> out;
  const auto append = [&](const std::string& scenario) {
    for (InputWorth& worth : worth_within(draws, info, scenario)) out.push_back(std::move(worth));
  };
  for (const std::string& scenario : scenarios) append(scenario);
  if (scenarios.size() > 1) append("");
  std::vector<double> chances;
  for (const InputWorth& worth : out) chances.push_back(worth.chance);
  const std::vector<double> corrected = holm(chances);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].corrected = corrected[i];
  return out;
}

}  // namespace tumble::scenarios
