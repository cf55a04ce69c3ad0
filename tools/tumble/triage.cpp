// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/triage.hpp"

#include <fmt/format.h>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/sweep_notes.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/gate_cases.hpp"
#include "tools/tumble/triage_suite.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::TriageRow;

struct TriageVerbOptions {
  std::string what, seed, seeds, method, metric;
  std::optional<double> limit;
  int jobs = available_processors();
  double memory_mib = scenarios::kWorkerMemoryMib;
  std::filesystem::path database;
};

std::string verdict(const TriageRow& row, const TriageRow& base) {
  if (!base.fails) return "";
  return row.fails ? "" : "cures";
}

Table table_of(const std::vector<TriageRow>& rows, const std::string& metric) {
  Table table("", {"replaced by its truth", "status", metric, "ratio to the first", "verdict", "what"});
  const TriageRow& base = rows.front();
  const double before = value_of(base.outcome.scores, metric);
  for (const TriageRow& row : rows) {
    const double now = value_of(row.outcome.scores, metric);
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
    const double value = value_of(row.outcome.scores, metric);
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
    return "the run does not fail (--metric and --limit define a failure); compare the values to see the influence of "
           "each input";
  std::string cures;
  for (const TriageRow& row : rows) {
    if (&row != &rows.front() && !row.fails) cures += (cures.empty() ? "" : ", ") + row.input;
  }
  return cures.empty()
             ? "no true value of a single input prevents the failure: the cause is in the method or in the scenario"
             : "cured by: " + cures;
}

scenarios::Failure failure_of(const TriageVerbOptions& options, const std::string& metric) {
  if (!options.limit) return {};
  if (!std::isfinite(*options.limit)) throw BadInput("--limit must be a finite number");
  return {metric, *options.limit};
}

int run_triage_of_draw(const Session& session, const TriageVerbOptions& options) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.what);
  const std::uint64_t seed = seed_of(scenario, options.seed);
  const scenarios::MethodPointer chosen = one_method(options.method, 0.9 * scenarios::TriageOptions{}.timeout_s);
  const scenarios::Method& method = *chosen;
  const std::string metric = metric_of(method, options.metric);
  scenarios::TriageOptions triage_options;
  triage_options.failure = failure_of(options, metric);
  triage_options.on_run = [&](const std::string& input) {
    session.note(input == "none" ? "original run" : "true: " + input);
  };
  const std::vector<TriageRow> rows = scenarios::triage(data, scenario, seed, method, triage_options);
  session.print({table_of(rows, metric)}, to_json(rows, metric));
  session.note(conclusion(rows));
  return kDone;
}

std::function<void(const std::string&)> known_name(const Session& session) {
  return [&session](const std::string& text) {
    if (!text.ends_with(".yaml")) scenarios::load_suite(session.data(), text);
  };
}

bool is_one_draw(const Session& session, const TriageVerbOptions& options) {
  const bool named = !options.what.ends_with(".yaml") && names_cases(session.data(), options.what);
  const bool one = !options.seed.empty() || (named && options.seeds.empty());
  if (one && (!options.seeds.empty() || !options.database.empty()))
    throw BadInput(
        "--seeds and --db apply to a suite only, but a single simulated run is requested; remove both options");
  return one;
}

std::string words_of(const TriageVerbOptions& options) {
  std::string words = " --method " + scenarios::shell_word(options.method);
  if (!options.metric.empty()) words += " --metric " + scenarios::shell_word(options.metric);
  if (options.limit) words += fmt::format(" --limit {}", *options.limit);
  return words;
}

int run_triage(const Session& session, const TriageVerbOptions& options) {
  if (is_one_draw(session, options)) return run_triage_of_draw(session, options);
  SuiteTriage asked;
  asked.method = one_method(options.method, 0.9 * asked.options.triage.timeout_s);
  asked.metric = metric_of(*asked.method, options.metric);
  asked.options.triage.failure = failure_of(options, asked.metric);
  asked.words = words_of(options);
  asked.options.jobs = options.jobs;
  asked.options.memory_mib = options.memory_mib;
  asked.suite = scenarios::load_suite(session.data(), options.what);
  if (!asked.suite.classes.empty() && !options.seeds.empty())
    throw BadInput(fmt::format("--seeds does not apply to suite '{}', because the suite lists its simulated runs",
                               asked.suite.name));
  if (!options.seeds.empty()) std::tie(asked.suite.first_seed, asked.suite.last_seed) = parse_seeds(options.seeds);
  asked.database = options.database;
  return run_suite_triage(session, std::move(asked));
}

}  // namespace

Action declare_triage(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<TriageVerbOptions>();
  verb.add("SCENARIO", options->what,
           "with --seed, analyses one simulated run of this scenario, named case or scenario file; without --seed, "
           "analyses the simulated runs of this suite, suite file or scenario")
      .required()
      .check(known_name(session));
  verb.add("--seed", options->seed,
           "sets the seed of a single simulated run [default: all runs of the suite; for a named case, the seed of the "
           "case]");
  verb.add("--seeds", options->seeds,
           "selects the seeds A..B of a suite, both included [default: the seeds of the suite]");
  verb.add("--db", options->database,
           "reads this results database and selects only simulated runs on which the method failed");
  verb.add("--jobs", options->jobs,
           "runs this number of processes in parallel, for a suite [default: number of processors]")
      .whole(1, 1024)
      .shows_default();
  verb.add("--memory", options->memory_mib,
           "limits the memory of each process, MiB; a simulated run beyond the limit has no result")
      .within(64.0, 1e7)
      .shows_default();
  verb.add("--method", options->method, "names the method that fails").required();
  verb.add("--metric", options->metric,
           "lists this metric; with --limit the metric also decides about failure [default: the first metric of the "
           "method's kind]");
  verb.add(
      "--limit", options->limit,
      "sets the limit of the metric of --metric in SI units; a run beyond the limit fails [default: a run fails only "
      "by its status or the metric map_failed]");
  return [&session, options] { return run_triage(session, *options); };
}

}  // namespace tumble::tools
