// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/score_tables.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/scoring/binned_metric.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::Kind;
using scenarios::Outcome;

std::string cell(const Outcome& outcome, const std::string& metric) {
  const scenarios::Score* const score = find_score(outcome.scores, metric);
  return score != nullptr ? number_text(score->value) : "";
}

Table kind_table(const std::string& title, const std::vector<const Outcome*>& outcomes, const std::string& said) {
  std::vector<std::string> header = {"metric"}, status = {"status"}, metrics;
  for (const Outcome* outcome : outcomes) {
    header.push_back(outcome->method);
    status.push_back(said.empty() ? to_string(outcome->status) : said);
    for (const scenarios::Score& score : outcome->scores) {
      if (scenarios::parse_binned(score.metric)) continue;  // binned scores need many runs
      if (std::find(metrics.begin(), metrics.end(), score.metric) == metrics.end()) metrics.push_back(score.metric);
    }
  }
  Table table(title, header);
  table.align_right_from(1);
  table.add_row(status);
  for (const std::string& metric : metrics) {
    std::vector<std::string> row = {metric};
    for (const Outcome* outcome : outcomes) row.push_back(cell(*outcome, metric));
    table.add_row(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<Table> score_tables(const std::string& title, std::span<const Outcome> outcomes,
                                const std::string& status) {
  std::vector<Table> tables;
  for (const Kind kind : scenarios::kKinds) {
    std::vector<const Outcome*> selected;
    for (const Outcome& outcome : outcomes) {
      if (outcome.kind == kind) selected.push_back(&outcome);
    }
    if (!selected.empty()) tables.push_back(kind_table(title + ": " + to_string(kind), selected, status));
  }
  return tables;
}

json score_rows(std::span<const Outcome> outcomes) {
  json rows = json::array();
  for (const Outcome& outcome : outcomes) {
    for (const scenarios::Score& score : outcome.scores) {
      rows.push_back({{"scenario", outcome.scenario},
                      {"seed", outcome.seed},
                      {"kind", to_string(outcome.kind)},
                      {"method", outcome.method},
                      {"status", to_string(outcome.status)},
                      {"metric", score.metric},
                      {"value", std::isfinite(score.value) ? json(score.value) : json()}});
    }
  }
  return rows;
}

json outcome_rows(std::span<const Outcome> outcomes) {
  json rows = json::array();
  for (const Outcome& outcome : outcomes) {
    rows.push_back({{"kind", to_string(outcome.kind)},
                    {"method", outcome.method},
                    {"status", to_string(outcome.status)},
                    {"message", outcome.message},
                    {"digest", outcome.estimate_digest}});
  }
  return rows;
}

std::string overall_status(std::span<const Outcome> outcomes) {
  for (const Outcome& outcome : outcomes) {
    if (outcome.status != scenarios::OutcomeStatus::ok) return to_string(outcome.status);
  }
  return "ok";
}

std::string interval_text(const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[-]";
  return "[" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json interval_json(const scenarios::Interval& interval) {
  return {{"value", finite(interval.value)}, {"low", finite(interval.low)}, {"high", finite(interval.high)}};
}

}  // namespace tumble::tools
