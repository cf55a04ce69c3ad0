// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/triage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "sim/lidar/surface.hpp"

namespace tumble::scenarios {

namespace {

TriageRow row_of(const std::string& input, const std::string& doc, Outcome outcome, const Failure& failure) {
  TriageRow row{input, doc, std::move(outcome), false};
  row.fails = failure.holds(row.outcome);
  return row;
}

}  // namespace

bool is_failed_verdict(const Score& score) {
  const MetricInfo& info = metric_info(score.metric);
  return info.unit == Unit::verdict && info.sense == Sense::lower && score.value != 0.0;
}

bool Failure::holds(const Outcome& outcome) const {
  if (outcome.status != OutcomeStatus::ok) return true;
  if (std::any_of(outcome.scores.begin(), outcome.scores.end(), is_failed_verdict)) return true;
  if (metric.empty()) return false;
  const Score* score = find_score(outcome.scores, metric);
  if (score == nullptr || std::isnan(score->value)) return true;  // no value counts as failed
  return metric_info(metric).sense == Sense::higher ? score->value < limit : score->value > limit;
}

std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options) {
  require_applies(method, scenario);
  const SimulatedDraw draw = simulate_draw(data, scenario, seed, 1);
  std::optional<sim::Surface> surface;
  if (method.info.kind == Kind::slam) surface.emplace(*draw.built);
  const sim::Surface* true_surface = surface ? &*surface : nullptr;

  std::vector<TriageRow> rows;
  const auto add = [&](TriageRow row) {
    if (options.on_row) options.on_row(row);
    rows.push_back(std::move(row));
  };
  if (options.on_run) options.on_run("none");
  add(row_of("none", "unchanged recording", run_isolated(method, draw, draw, true_surface, options.timeout_s),
             options.failure));
  for (const TrueInput& input : true_inputs()) {
    SimulatedDraw cured = draw;
    if (!input.replace(cured.recording.sensors, draw.recording.truth)) continue;
    if (options.on_run) options.on_run(input.name);
    add(row_of(input.name, input.doc,
               run_isolated(method, cured, scored_by(draw, cured), true_surface, options.timeout_s), options.failure));
  }
  return rows;
}

}  // namespace tumble::scenarios
