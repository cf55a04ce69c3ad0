// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/summary/input_worth.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/suite_triage.hpp"
#include "scenarios/sweep/triage.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/gate_cases.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/session.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct SuiteTriage {
  scenarios::Suite suite;
  scenarios::MethodPointer method;
  std::string metric;  ///< measures an input's effect
  std::string words;   ///< options for the printed command
  scenarios::SuiteTriageOptions options;
  std::filesystem::path database;  ///< only runs that failed there
};

using nlohmann::json;
using scenarios::BadInput;
using scenarios::DrawName;
using scenarios::DrawTriage;
using scenarios::InputWorth;

std::string known_interval_text(const scenarios::Interval& interval) {
  if (std::isnan(interval.value)) return "";
  return fmt::format("[{}, {}]", number_text(interval.low), number_text(interval.high));
}

std::string value_text(double value) {
  return std::isnan(value) ? "" : number_text(value);
}

Table table_of(const std::vector<InputWorth>& worths, const std::string& metric) {
  Table table("by " + metric,
              {"scenario", "replaced by its truth", "draws", "failed", "cured", "share cured", "95 % interval",
               "broken", "median improvement", "95 % interval ", "better", "worse", "chance"});
  for (const InputWorth& worth : worths) {
    table.add_row({worth.scenario.empty() ? "all" : worth.scenario, worth.input, std::to_string(worth.draws),
                   std::to_string(worth.failed), std::to_string(worth.cured), value_text(worth.cured_share.value),
                   known_interval_text(worth.cured_share), std::to_string(worth.broken),
                   value_text(worth.improvement.value), known_interval_text(worth.improvement),
                   std::to_string(worth.better), std::to_string(worth.worse), fmt::format("{:.2g}", worth.corrected)});
  }
  return table;
}

json signed_number_json(double value) {
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return std::isnan(value) ? json() : json(value);
}

json signed_interval_json(const scenarios::Interval& interval) {
  return {{"value", signed_number_json(interval.value)},
          {"low", signed_number_json(interval.low)},
          {"high", signed_number_json(interval.high)}};
}

json draw_json(const DrawTriage& draw, const std::string& words) {
  json runs = json::array();
  for (const scenarios::TriageRow& row : draw.rows)
    runs.push_back({{"input", row.input}, {"status", to_string(row.outcome.status)}, {"fails", row.fails}});
  return {{"scenario", draw.draw.scenario},
          {"seed", draw.draw.seed},
          {"trouble", draw.error_code},
          {"runs", runs},
          {"again", fmt::format("tumble triage {} --seed {}{}", scenarios::shell_word(draw.draw.scenario),
                                draw.draw.seed, words)}};
}

json to_json(const std::vector<InputWorth>& worths, const std::vector<DrawTriage>& draws, const SuiteTriage& asked) {
  json rows = json::array(), all = json::array();
  for (const InputWorth& worth : worths) {
    rows.push_back({{"scenario", worth.scenario},
                    {"input", worth.input},
                    {"doc", worth.doc},
                    {"draws", worth.draws},
                    {"failed", worth.failed},
                    {"cured", worth.cured},
                    {"broken", worth.broken},
                    {"share_cured", signed_interval_json(worth.cured_share)},
                    {"median_improvement", signed_interval_json(worth.improvement)},
                    {"better", worth.better},
                    {"worse", worth.worse},
                    {"chance", worth.chance},
                    {"corrected", worth.corrected}});
  }
  for (const DrawTriage& draw : draws) all.push_back(draw_json(draw, asked.words));
  return {{"suite", asked.suite.name},
          {"method", full_name(asked.method->info)},
          {"metric", asked.metric},
          {"inputs", std::move(rows)},
          {"draws", std::move(all)}};
}

std::string conclusion(const std::vector<InputWorth>& worths) {
  if (worths.empty()) return "no simulated run could be completed";
  const std::string& whole = worths.back().scenario;  // all scenarios, if there are several
  const auto is_single = [&](const InputWorth& worth) { return worth.scenario == whole && worth.input != "all"; };
  const auto first = std::find_if(worths.begin(), worths.end(), is_single);
  if (first == worths.end()) return "no input of the method could be replaced by its true value";
  const std::string name = first->input + " (" + first->doc + ")";
  if (first->cured > 0)
    return fmt::format("the input {} has the strongest influence: its true value prevents {} of {} failures", name,
                       first->cured, first->failed);
  const std::string failures = first->failed == 0
                                   ? "the method succeeded on all simulated runs (--failure defines a failure)"
                                   : "replacing one input by its true value never prevents a failure";
  if (first->better <= first->worse)
    return fmt::format("{}; the true value of every input worsens at least as many simulated runs as it improves",
                       failures);
  return fmt::format("{}; the true value of {} improves {} of {} simulated runs", failures, name, first->better,
                     first->better + first->worse);
}

std::vector<DrawName> chosen_draws(const Session& session, const SuiteTriage& asked) {
  std::vector<DrawName> draws = scenarios::draws_of(session.data(), asked.suite, *asked.method);
  if (draws.empty())
    throw BadInput(
        fmt::format("method '{}' applies to no scenario of suite '{}'", asked.method->info.name, asked.suite.name));
  if (asked.database.empty()) return draws;
  const scenarios::Results results(asked.database, scenarios::Results::Mode::read_only);
  const auto failed = scenarios::failed_draws(results, *asked.method, asked.options.triage.failure);
  std::erase_if(draws, [&](const DrawName& draw) { return !failed.contains(draw); });
  if (draws.empty())
    throw BadInput(fmt::format("{}: {} failed on none of the selected simulated runs in this database",
                               asked.database.string(), full_name(asked.method->info)));
  return draws;
}

std::string line_of(const DrawTriage& draw) {
  const std::string name = fmt::format("{} {}: ", draw.draw.scenario, draw.draw.seed);
  if (draw.rows.empty()) return name + draw.error_code;
  if (!draw.error_code.empty()) return name + "incomplete: " + draw.error_code;
  if (!draw.rows.front().fails) return name + "does not fail";
  std::string cures;
  for (const scenarios::TriageRow& row : draw.rows) {
    if (!row.fails) cures += (cures.empty() ? "" : ", ") + row.input;
  }
  return cures.empty() ? fmt::format("{}fails; replacing one input by its true value never prevents the failure", name)
                       : fmt::format("{}fails; the true values of these inputs prevent the failure: {}", name, cures);
}

std::string first_trouble(const std::vector<DrawTriage>& draws) {
  const auto first =
      std::find_if(draws.begin(), draws.end(), [](const DrawTriage& draw) { return !draw.error_code.empty(); });
  return first == draws.end() ? "" : line_of(*first);
}

int run_suite_triage(const Session& session, SuiteTriage asked) {
  if (!asked.suite.recordings.empty())
    throw BadInput(
        fmt::format("suite '{}' contains recordings, but only inputs of simulated runs can be replaced by true values",
                    asked.suite.name));
  const std::vector<DrawName> draws = chosen_draws(session, asked);
  const InterruptFlag interrupt;
  std::size_t done = 0, failed = 0;
  asked.options.stop = &interrupt.raised();
  asked.options.on_draw = [&](const DrawTriage& draw) {
    ++done;
    failed += !draw.rows.empty() && draw.rows.front().fails ? 1 : 0;
    session.note(fmt::format("{} of {} simulated runs, {} failed: {}", done, draws.size(), failed, line_of(draw)));
  };
  const std::vector<DrawTriage> triaged = scenarios::triage_draws(session.data(), draws, *asked.method, asked.options);
  const std::vector<InputWorth> worths = scenarios::worth_of_inputs(triaged, asked.metric);
  session.print({table_of(worths, asked.metric)}, to_json(worths, triaged, asked));
  session.note(conclusion(worths));
  const auto troubled =
      std::count_if(triaged.begin(), triaged.end(), [](const DrawTriage& draw) { return !draw.error_code.empty(); });
  if (troubled > 0)
    std::fprintf(
        stderr,
        "tumble: %td of %zu simulated runs have no result or an incomplete result; the first of these runs is %s\n",
        troubled, triaged.size(), first_trouble(triaged).c_str());
  if (triaged.size() == draws.size()) return kDone;
  std::fprintf(stderr, "tumble: stopped after %zu of %zu simulated runs; the table covers only these runs\n",
               triaged.size(), draws.size());
  return kCheckFailed;
}

using nlohmann::json;
using scenarios::BadInput;
using scenarios::TriageRow;

struct TriageVerbOptions {
  std::string what, seed, seeds, method, metric, failure;
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
    return "the run does not fail (--failure defines a failure); compare the values to see the influence of "
           "each input";
  std::string cures;
  for (const TriageRow& row : rows) {
    if (&row != &rows.front() && !row.fails) cures += (cures.empty() ? "" : ", ") + row.input;
  }
  return cures.empty() ? "replacing one input by its true value never prevents the failure; the cause is in the method "
                         "or in the scenario"
                       : "cured by: " + cures;
}

std::string listed_metric(const TriageVerbOptions& options, const scenarios::Method& method,
                          const scenarios::FailureGoal& failure) {
  return metric_of(method, options.metric.empty() ? failure.metric : options.metric);
}

int run_triage_of_draw(const Session& session, const TriageVerbOptions& options) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.what);
  const std::uint64_t seed = seed_of(scenario, options.seed);
  const scenarios::MethodPointer chosen = one_method(options.method, 0.9 * scenarios::TriageOptions{}.timeout_s);
  const scenarios::Method& method = *chosen;
  scenarios::TriageOptions triage_options;
  triage_options.failure = failure_of(method, options.failure);
  const std::string metric = listed_metric(options, method, triage_options.failure);
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
  if (!options.failure.empty()) words += " --failure " + scenarios::shell_word(options.failure);
  return words;
}

int run_triage(const Session& session, const TriageVerbOptions& options) {
  if (is_one_draw(session, options)) return run_triage_of_draw(session, options);
  SuiteTriage asked;
  asked.method = one_method(options.method, 0.9 * asked.options.triage.timeout_s);
  asked.options.triage.failure = failure_of(*asked.method, options.failure);
  asked.metric = listed_metric(options, *asked.method, asked.options.triage.failure);
  asked.words = words_of(options);
  asked.options.jobs = options.jobs;
  asked.options.memory_mib = options.memory_mib;
  asked.suite = scenarios::load_suite(session.data(), options.what);
  if (!asked.suite.classes.empty() && !options.seeds.empty())
    throw BadInput(fmt::format("--seeds does not apply to suite '{}', because the suite file lists the simulated runs",
                               asked.suite.name));
  if (!options.seeds.empty()) std::tie(asked.suite.first_seed, asked.suite.last_seed) = parse_seeds(options.seeds);
  asked.database = options.database;
  return run_suite_triage(session, std::move(asked));
}

}  // namespace

Action declare_triage(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<TriageVerbOptions>();
  verb.add("SCENARIO", options->what,
           "analyses the simulated runs of this suite, suite file or scenario. With --seed, analyses one simulated run "
           "of this scenario, named case or scenario file")
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
  verb.add("--failure", options->failure, kFailureHelp);
  verb.add("--metric", options->metric,
           "lists this metric [default: the metric of --failure, or the first metric of the method's kind]");
  return [&session, options] { return run_triage(session, *options); };
}

}  // namespace tumble::tools
