// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/bench_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/metric.hpp"

namespace tumble::tools {

namespace {

using scenarios::BenchCell;
using scenarios::BenchResult;

constexpr const char* kCost = "estimate_cpu_s";
constexpr std::size_t kVersionShown = 40;

struct MethodRow {
  const BenchResult* result;
  std::string label;
};

std::vector<MethodRow> rows_of(const BenchPage& page) {
  std::vector<MethodRow> rows;
  for (const BenchResult& each : page.ran) rows.push_back({&each, each.method + " (now)"});
  for (const BenchResult& each : page.stored) rows.push_back({&each, each.method});
  return rows;
}

const BenchResult* baseline_of(const std::vector<MethodRow>& rows) {
  const BenchResult* first = nullptr;
  for (const scenarios::Method& method : scenarios::methods()) {
    if (method.info.kind != rows.front().result->kind) continue;
    const auto is_it = [&](const MethodRow& row) { return row.result->method == method.info.name; };
    const auto row = std::find_if(rows.begin(), rows.end(), is_it);
    if (row == rows.end()) continue;
    if (method.info.baseline) return row->result;
    if (first == nullptr) first = row->result;
  }
  return first;
}

std::string cell_text(const BenchCell& cell) {
  if (cell.draws == 0) return "";
  if (std::isinf(cell.median)) return fmt::format("failed ({} of {})", cell.lost, cell.draws);
  const std::string median = number_text(cell.median);
  return cell.lost == 0 ? median : fmt::format("{} (failed {} of {})", median, cell.lost, cell.draws);
}

Table metric_table(const scenarios::Suite& suite, const std::string& metric, const std::vector<MethodRow>& rows,
                   const std::vector<BenchResult>& all) {
  const BenchResult* baseline = baseline_of(rows);
  std::vector<std::string> header = {"method"};
  for (const scenarios::DrawClass& each : suite.classes)
    header.push_back(fmt::format("{} ({})", each.name, each.draws.size()));
  header.emplace_back("all");
  if (baseline != nullptr) header.push_back("better than " + baseline->method + " in");
  Table table(fmt::format("{}: median, {}", metric, sense_text(scenarios::metric_info(metric))), header);
  table.align_right_from(1);
  for (const MethodRow& row : rows) {
    std::vector<std::string> cells = {row.label};
    for (const scenarios::DrawClass& each : suite.classes)
      cells.push_back(cell_text(scenarios::bench_cell(*row.result, metric, each.name, all)));
    cells.push_back(cell_text(scenarios::bench_cell(*row.result, metric, "", all)));
    if (baseline != nullptr && row.result != baseline) {
      const scenarios::BenchWins wins = scenarios::bench_wins(*row.result, *baseline, metric, all);
      cells.push_back(wins.draws == 0 ? "" : fmt::format("{} of {}", wins.better, wins.draws));
    }
    table.add_row(std::move(cells));
  }
  return table;
}

Table origin_table(const scenarios::Suite& suite, const std::vector<MethodRow>& rows,
                   const std::vector<BenchResult>& all) {
  Table table(fmt::format("origin of the results; {} {}", suite.name, scenarios::bench_suite_digest(suite)),
              {"method", "ok", "not ok", "CPU s per draw", "date", "version", "build"});
  for (const MethodRow& row : rows) {
    std::map<std::string, int> counts;
    for (const scenarios::BenchDraw& draw : row.result->draws) ++counts[to_string(draw.status)];
    const int ok = counts["ok"];
    counts.erase("ok");
    std::string others;
    for (const auto& [status, count] : counts)
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", count, status);
    const std::string version = row.result->version.empty() ? "this build's" : row.result->version;
    table.add_row({row.label, std::to_string(ok), others, number_text(bench_cell(*row.result, kCost, "", all).median),
                   row.result->date, version.substr(0, kVersionShown), row.result->build});
  }
  return table;
}

Table failure_table(const std::vector<BenchResult>& ran, std::span<const scenarios::Outcome> outcomes) {
  Table table("failed runs", {"method", "draw", "class", "status", "message"});
  for (const BenchResult& result : ran) {
    for (const scenarios::BenchDraw& draw : result.draws) {
      if (draw.status == scenarios::OutcomeStatus::ok) continue;
      const auto is_it = [&](const scenarios::Outcome& outcome) {
        return outcome.scenario == draw.scenario && outcome.seed == draw.seed && outcome.kind == result.kind &&
               outcome.method == result.method;
      };
      const auto outcome = std::find_if(outcomes.begin(), outcomes.end(), is_it);
      table.add_row({result.method, fmt::format("{} {}", draw.scenario, draw.seed), draw.group, to_string(draw.status),
                     outcome == outcomes.end() ? "" : outcome->message});
    }
  }
  return table;
}

}  // namespace

std::vector<Table> bench_tables(const scenarios::Suite& suite, const BenchPage& page,
                                std::span<const scenarios::Outcome> outcomes) {
  const std::vector<MethodRow> rows = rows_of(page);
  std::vector<BenchResult> all = page.ran;
  all.insert(all.end(), page.stored.begin(), page.stored.end());
  std::vector<Table> tables;
  const std::vector<std::string> metrics =
      suite.shown_metrics.empty() ? scenarios::headline_metrics(page.ran.front().kind) : suite.shown_metrics;
  for (const std::string& metric : metrics) tables.push_back(metric_table(suite, metric, rows, all));
  tables.push_back(origin_table(suite, rows, all));
  Table failures = failure_table(page.ran, outcomes);
  if (!failures.empty()) tables.push_back(std::move(failures));
  if (!page.left_out.empty()) {
    Table table("not compared", {"stored result"});
    for (const std::string& each : page.left_out) table.add_row({each});
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace tumble::tools
