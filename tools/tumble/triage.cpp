// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/triage.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/scoring/metric.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::TriageRow;

struct Options {
  std::string scenario, seed, method, metric;
  std::optional<double> limit;
};

scenarios::MethodPointer choose(const std::string& name) {
  const std::vector<scenarios::MethodPointer> found =
      scenarios::find_methods_within(std::vector<std::string>{name}, 0.9 * scenarios::TriageOptions{}.timeout_s);
  if (found.size() == 1) return found.front();
  std::string line = "--method " + name + " names several methods; say which:";
  for (const scenarios::MethodPointer& method : found)
    line += std::string(" ") + to_string(method->info.kind) + "/" + method->info.name;
  throw BadInput(line);
}

/// The metric named, of the method's kind, or the kind's first.
std::string metric_of(const scenarios::Method& method, const Options& options) {
  if (options.metric.empty()) return scenarios::headline_metrics(method.info.kind).front();
  std::vector<std::string> known;
  for (const scenarios::Metric& metric : scenarios::metrics()) {
    if (metric.kind == method.info.kind) known.push_back(metric.info.name);
  }
  require_known(std::string("metric of kind ") + to_string(method.info.kind), options.metric, known);
  return options.metric;
}

double value_of(const TriageRow& row, const std::string& metric) {
  for (const scenarios::Score& score : row.outcome.scores) {
    if (score.metric == metric) return score.value;
  }
  return std::nan("");
}

/// "cures" when the run failed as it was and does not with this input true.
std::string verdict(const TriageRow& row, const TriageRow& base) {
  if (!base.fails) return "";
  return row.fails ? "" : "cures";
}

Table table_of(const std::vector<TriageRow>& rows, const std::string& metric) {
  Table table("", {"replaced by its truth", "status", metric, "of the first", "verdict", "what"});
  const TriageRow& base = rows.front();
  const double before = value_of(base, metric);
  for (const TriageRow& row : rows) {
    const double now = value_of(row, metric);
    const std::string change =
        &row == &base || !(before > 0.0) || !std::isfinite(now) ? "" : fmt::format("{:.2f}", now / before);
    table.add_row({row.input, to_string(row.outcome.status), number_text(now), change,
                   &row == &base ? (base.fails ? "fails" : "does not fail") : verdict(row, base), row.doc});
  }
  return table;
}

json to_json(const std::vector<TriageRow>& rows, const std::string& metric) {
  json out = json::array(), cures = json::array();
  for (const TriageRow& row : rows) {
    const double value = value_of(row, metric);
    out.push_back({{"input", row.input},
                   {"doc", row.doc},
                   {"status", to_string(row.outcome.status)},
                   {"message", row.outcome.message},
                   {"value", std::isfinite(value) ? json(value) : json()},
                   {"fails", row.fails}});
    if (&row != &rows.front() && verdict(row, rows.front()) == "cures") cures.push_back(row.input);
  }
  return {{"metric", metric}, {"fails", rows.front().fails}, {"cures", cures}, {"runs", out}};
}

std::string conclusion(const std::vector<TriageRow>& rows) {
  if (!rows.front().fails)
    return "the run does not fail (see --metric and --limit); the values say what each input is worth";
  std::string cures;
  for (const TriageRow& row : rows) {
    if (&row != &rows.front() && !row.fails) cures += (cures.empty() ? "" : ", ") + row.input;
  }
  return cures.empty() ? "no input cures the failure: it lies in the method or in the scenario" : "cured by: " + cures;
}

int run_triage(const Session& session, const Options& options) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.scenario);
  const std::uint64_t seed = parse_seed(options.seed);
  const scenarios::MethodPointer chosen = choose(options.method);
  const scenarios::Method& method = *chosen;
  const std::string metric = metric_of(method, options);
  if (!options.metric.empty() && !options.limit) throw BadInput("--metric needs --limit: from where on a run fails");
  scenarios::TriageOptions triage_options;
  if (options.limit && !std::isfinite(*options.limit)) throw BadInput("--limit is not a finite number");
  if (options.limit) triage_options.failure = {metric, *options.limit};
  triage_options.on_run = [&](const std::string& input) {
    session.note(input == "none" ? "as it is" : "true: " + input);
  };
  const std::vector<TriageRow> rows = scenarios::triage(data, scenario, seed, method, triage_options);
  session.print({table_of(rows, metric)}, to_json(rows, metric));
  session.note(conclusion(rows));
  return kDone;
}

}  // namespace

Action declare_triage(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("SCENARIO", options->scenario, "a scenario of the catalogue, or a scenario file")
      ->required()
      ->check(a_scenario(session));
  app.add_option("--seed", options->seed, "which draw of it")->required();
  app.add_option("--method", options->method, "the method that fails")->required();
  app.add_option("--metric", options->metric,
                 "what is shown, and with --limit what fails [the first of the method's kind]");
  app.add_option("--limit", options->limit, "a run fails beyond this value, SI [on status and map_failed alone]");
  return [&session, options] { return run_triage(session, *options); };
}

}  // namespace tumble::tools
