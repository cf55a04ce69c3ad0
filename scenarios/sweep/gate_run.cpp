// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/gate.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::uint64_t kDrawsMax = 1000;  // the exact tests take cubic time

MethodRun& method_run(const Outcome& outcome, GateRun& run) {
  for (MethodRun& each : run.methods) {
    if (each.scenario == outcome.scenario && each.kind == outcome.kind && each.method == outcome.method) return each;
  }
  run.methods.push_back({outcome.scenario, outcome.kind, outcome.method, {}, {}});
  run.methods.back().status.resize(run.seeds.size());
  return run.methods.back();
}

void add(const Outcome& outcome, GateRun& run) {
  const auto seed = std::lower_bound(run.seeds.begin(), run.seeds.end(), outcome.seed);
  if (seed == run.seeds.end() || *seed != outcome.seed || !outcome.setting.is_plain()) return;
  const auto draw = static_cast<std::size_t>(seed - run.seeds.begin());
  MethodRun& method = method_run(outcome, run);
  method.status[draw] = outcome.status;
  if (outcome.status != OutcomeStatus::ok) return;
  const std::vector<std::string> held = held_metrics(outcome.kind);
  for (const Score& score : outcome.scores) {
    if (std::find(held.begin(), held.end(), score.metric) == held.end()) continue;
    std::vector<double>& values = method.values[score.metric];
    values.resize(run.seeds.size(), std::numeric_limits<double>::quiet_NaN());
    values[draw] = score.value;
  }
}

}  // namespace

GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last) {
  if (last < first || last - first >= kDrawsMax) {
    throw BadInput(
        fmt::format("'tumble gate' compares 1 to {} seeds, but the given range is {} to {}", kDrawsMax, first, last));
  }
  GateRun run;
  for (std::uint64_t seed = first; seed <= last; ++seed) run.seeds.push_back(seed);
  for (const Outcome& outcome : outcomes) add(outcome, run);
  std::sort(run.methods.begin(), run.methods.end(), [](const MethodRun& a, const MethodRun& b) {
    return std::tie(a.scenario, a.kind, a.method) < std::tie(b.scenario, b.kind, b.method);
  });
  return run;
}

GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last) {
  std::vector<Outcome> outcomes = results.outcomes();
  std::size_t at = 0;
  for (const ScoreRow& row : results.scores()) {
    if (row.kind.empty()) continue;  // rejected run
    const auto is_of = [&](const Outcome& outcome) {
      return outcome.scenario == row.scenario && outcome.seed == row.seed && row.kind == to_string(outcome.kind) &&
             outcome.method == row.method;
    };
    while (at < outcomes.size() && !is_of(outcomes[at])) ++at;
    if (at == outcomes.size()) break;
    outcomes[at].scores.push_back({row.metric, row.value});
  }
  return gate_run(outcomes, first, last);
}

}  // namespace tumble::scenarios
