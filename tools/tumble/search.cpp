// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/search/failure_search.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/progress.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/sweeping.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

/// ShownDraw is a draw of a search with the command that reproduces it.
struct ShownDraw {
  scenarios::FoundFailure found;
  std::string command;
};

struct ShownSearch {
  std::string scenario, method;
  scenarios::FailureGoal goal;
  scenarios::SearchResult result;
  std::vector<ShownDraw> draws;  ///< most likely failures, or the worst draw
};

using nlohmann::json;
using scenarios::InputShift;
using scenarios::Interval;
using scenarios::SplittingLevel;

/// Shifts are listed up to this number.
constexpr std::size_t kShiftsShown = 5;

/// Returns the number of independent draws whose failures would give an equally narrow interval.
double plain_draws(const Interval& p) {
  constexpr double kSigmas = 1.959963984540054;
  if (p.value <= 0.0 || p.low <= 0.0) return -std::log(0.025) / p.high;
  const double deviation = std::log(p.high / p.low) / (2.0 * kSigmas);
  return (1.0 - p.value) / (p.value * deviation * deviation);
}

Table probability_table(const ShownSearch& shown) {
  const scenarios::SearchResult& result = shown.result;
  Table table(fmt::format("{}: probability that {} fails ({})", shown.scenario, shown.method, shown.goal.text()),
              {"probability", "95 % interval", "bound reached", "runs", "failures found", "not simulated",
               "runs of 'tumble sweep' for an equally narrow interval"});
  const Interval& p = result.splitting.probability;
  table.add_row({number_text(p.value), interval_text(p), result.splitting.complete ? "yes" : "no",
                 std::to_string(result.splitting.draws.size()), std::to_string(result.failures),
                 std::to_string(result.rejected), number_text(plain_draws(p))});
  return table;
}

Table levels_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: levels of {}", shown.scenario, shown.goal.metric),
              {"level", "probability", "95 % interval", "runs", "initial runs", "moves", "accepted"});
  for (const SplittingLevel& level : shown.result.splitting.levels) {
    table.add_row({number_text(shown.goal.value_at(level.score)), number_text(level.probability.value),
                   interval_text(level.probability), std::to_string(level.runs), std::to_string(level.families),
                   std::to_string(level.moves), fmt::format("{:.0f} %", 100.0 * level.accepted)});
  }
  return table;
}

Table shifts_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: random parameters of the worst simulated runs", shown.scenario),
              {"number", "shift [sigma]", "Holm p", "quantiles 0.1, 0.5, 0.9 in the worst runs", "in the scenario"});
  for (std::size_t i = 0; i < shown.result.shifts.size() && i < kShiftsShown; ++i) {
    const InputShift& each = shown.result.shifts[i];
    const auto three = [](double low, double middle, double high) {
      return fmt::format("{}, {}, {}", number_text(low), number_text(middle), number_text(high));
    };
    table.add_row({each.number, fmt::format("{:+.2f}", each.shift), chance_text(each.corrected),
                   three(each.low, each.median, each.high),
                   three(each.scenario_low, each.scenario_median, each.scenario_high)});
  }
  return table;
}

Table draws_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: simulated runs that the search found", shown.scenario),
              {"run", "status", shown.goal.metric, "distance [sigma]", "command"});
  for (const ShownDraw& each : shown.draws) {
    table.add_row({std::to_string(each.found.run), to_string(each.found.status), number_text(each.found.value),
                   fmt::format("{:.2f}", each.found.distance), each.command});
  }
  return table;
}

json shift_json(const InputShift& each) {
  return {{"number", each.number},
          {"shift", each.shift},
          {"holm_p", each.corrected},
          {"draws", {each.low, each.median, each.high}},
          {"scenario", {each.scenario_low, each.scenario_median, each.scenario_high}}};
}

/// Returns four tables: probability, levels, shifts of the random parameters, and draws. Empty tables are omitted.
std::vector<Table> tables_of(const ShownSearch& shown) {
  std::vector<Table> out = {probability_table(shown)};
  for (Table& table : std::vector<Table>{levels_table(shown), shifts_table(shown), draws_table(shown)}) {
    if (!table.empty()) out.push_back(std::move(table));
  }
  return out;
}

json json_of(const ShownSearch& shown) {
  const scenarios::SearchResult& result = shown.result;
  json levels = json::array(), shifts = json::array(), draws = json::array();
  for (const SplittingLevel& level : result.splitting.levels) {
    levels.push_back({{"level", finite(shown.goal.value_at(level.score))},
                      {"probability", interval_json(level.probability)},
                      {"runs", level.runs},
                      {"families", level.families},
                      {"moves", level.moves},
                      {"accepted", level.accepted}});
  }
  for (const InputShift& each : result.shifts) shifts.push_back(shift_json(each));
  for (const ShownDraw& each : shown.draws) {
    draws.push_back({{"run", each.found.run},
                     {"status", to_string(each.found.status)},
                     {"value", finite(each.found.value)},
                     {"distance", each.found.distance},
                     {"seed", each.found.seed},
                     {"command", each.command}});
  }
  return {{"scenario", shown.scenario},
          {"method", shown.method},
          {"failure", shown.goal.text()},
          {"probability", interval_json(result.splitting.probability)},
          {"reached", result.splitting.complete},
          {"runs", result.splitting.draws.size()},
          {"failures", result.failures},
          {"rejected", result.rejected},
          {"plain_draws", finite(plain_draws(result.splitting.probability))},
          {"levels", std::move(levels)},
          {"numbers", std::move(shifts)},
          {"draws", std::move(draws)}};
}

using scenarios::BadInput;
using scenarios::FoundFailure;
using scenarios::SearchResult;

constexpr std::size_t kDrawsShown = 5;
/// With more moves per copy, the measured coverage of the interval is below 92 % (docs/maths/statistics.md).
constexpr std::size_t kMovesOfDrawnSearch = 200;

struct SearchVerbOptions {
  std::string suite, method, failure, worst;
  std::vector<std::string> scenarios;
  int budget = 1000, population = 50, seed = 1;
  int jobs = available_processors();
  double memory_mib = scenarios::kWorkerMemoryMib;
  std::filesystem::path database;
};

scenarios::FailureGoal goal_of(const SearchVerbOptions& options, const scenarios::Method& method) {
  if (options.failure.empty() == options.worst.empty())
    throw BadInput("give either --failure 'METRIC > VALUE' or --worst METRIC");
  if (!options.failure.empty()) return scenarios::parse_goal(options.failure, method.info.kind);
  scenarios::FailureGoal goal{metric_of(method, options.worst), std::numeric_limits<double>::infinity()};
  if (scenarios::metric_info(goal.metric).sense == scenarios::Sense::higher) goal.limit = -goal.limit;
  return goal;
}

scenarios::Suite suite_of(const scenarios::DataRoot& data, const SearchVerbOptions& options) {
  scenarios::Suite suite = scenarios::load_suite(data, options.suite);
  if (!suite.recordings.empty())
    throw BadInput(fmt::format("suite '{}' contains recordings, which have no random parameters", suite.name));
  take_scenarios(options.scenarios, suite);
  return suite;
}

scenarios::SearchOptions search_options(const SearchVerbOptions& options, const scenarios::Suite& suite,
                                        const std::atomic<bool>& stop) {
  if (options.budget < options.population)
    throw BadInput(
        fmt::format("--budget is {}; it must be at least --population, {}", options.budget, options.population));
  scenarios::SearchOptions out;
  out.population = static_cast<std::size_t>(options.population);
  out.budget = static_cast<std::size_t>(options.budget);
  out.seed = static_cast<std::uint64_t>(options.seed);
  out.timeout_s = suite.timeout_s;
  out.jobs = options.jobs;
  out.memory_mib = options.memory_mib;
  out.stop = &stop;
  return out;
}

/// Writes the scenario of a draw next to the database, and returns the command that reproduces the run.
std::string write_draw(const SearchVerbOptions& options, const scenarios::Method& method, const FoundFailure& draw) {
  const std::filesystem::path folder = options.database.string() + ".files/failures";
  make_folder(folder);
  const std::filesystem::path file = folder / fmt::format("{}_{}_{}_{}.yaml", draw.scenario.name,
                                                          to_string(method.info.kind), method.info.name, draw.run);
  scenarios::replace_file(file, scenarios::to_yaml(draw.scenario));
  return fmt::format("tumble run {} --seed {} --method {}", scenarios::shell_word(file.string()), draw.seed,
                     scenarios::shell_word(options.method));
}

std::vector<ShownDraw> write_draws(const SearchVerbOptions& options, const scenarios::Method& method,
                                   const SearchResult& result) {
  std::vector<FoundFailure> chosen = result.likely;
  chosen.resize(std::min(chosen.size(), kDrawsShown));
  if (!options.worst.empty()) chosen = {result.worst};
  std::vector<ShownDraw> out;
  for (const FoundFailure& each : chosen) out.push_back({each, write_draw(options, method, each)});
  return out;
}

SearchResult search_with_progress(const Session& session, const scenarios::DataRoot& data,
                                  const scenarios::Scenario& scenario, const scenarios::Method& method,
                                  const scenarios::FailureGoal& goal, scenarios::Results& results,
                                  scenarios::SearchOptions options) {
  ProgressDisplay shown = ProgressDisplay::on_standard_error();
  const double start_s = scenarios::now_s();
  SearchProgress progress{0, options.budget, 0, 0.0};
  options.on_runs = [&](std::size_t runs, std::size_t failures) {
    progress.runs = runs;
    progress.failures = failures;
    progress.elapsed_s = scenarios::now_s() - start_s;
    if (!session.quiet) shown.show(progress);
  };
  SearchResult result = scenarios::search_failures(data, scenario, method, goal, results, options);
  if (!session.quiet) shown.finish(progress);
  return result;
}

void say_result(const Session& session, const ShownSearch& shown) {
  const scenarios::SplittingResult& splitting = shown.result.splitting;
  if (!splitting.complete)
    session.note(
        fmt::format("{}: the --budget ended too early, so the interval of the probability is wide. A larger --budget "
                    "with the same database continues the search",
                    shown.scenario));
  const double plain = plain_draws(splitting.probability);
  if (splitting.complete && plain < static_cast<double>(splitting.draws.size()))
    session.note(
        fmt::format("{}: 'tumble sweep' needs only {:.0f} simulated runs for an equally narrow interval of the failure "
                    "probability. This failure is frequent or depends on noise",
                    shown.scenario, plain));
  const bool is_stuck = std::any_of(splitting.levels.begin(), splitting.levels.end(),
                                    [](const auto& level) { return level.moves > kMovesOfDrawnSearch; });
  if (is_stuck)
    session.note(
        fmt::format("{}: the interval of the failure probability may be too narrow. The search rejects most new seeds, "
                    "because noise or terrain cause the failures",
                    shown.scenario));
  if (!shown.draws.empty())
    session.note("to simplify a listed run, give the file, seed and method in the run's command to 'tumble shrink'");
}

int search(const Session& session, const SearchVerbOptions& options) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Suite suite = suite_of(data, options);
  const scenarios::MethodPointer method = one_method(options.method, 0.9 * suite.timeout_s);
  const scenarios::FailureGoal goal = goal_of(options, *method);
  const InterruptFlag interrupt;
  const scenarios::SearchOptions how = search_options(options, suite, interrupt.raised());
  if (options.database.has_parent_path()) make_folder(options.database.parent_path());
  const scenarios::DatabaseOwner owner(options.database);
  scenarios::Results results = scenarios::open_results(data, suite, options.database);
  certify_results_file(session, data, options.database, interrupt.raised());

  std::vector<Table> tables;
  nlohmann::json rows = nlohmann::json::array();
  bool stopped = false;
  for (const std::string& name : suite.scenarios) {
    const scenarios::Scenario scenario = scenarios::load_scenario(data, name);
    if (stopped || !method->info.applies_to(scenarios::subject_of(scenario))) continue;
    ShownSearch shown{scenario.name, full_name(method->info), goal, {}, {}};
    shown.result = search_with_progress(session, data, scenario, *method, goal, results, how);
    stopped = shown.result.splitting.stopped;
    if (stopped) break;
    shown.draws = write_draws(options, *method, shown.result);
    for (Table& table : tables_of(shown)) tables.push_back(std::move(table));
    rows.push_back(json_of(shown));
    say_result(session, shown);
  }
  if (tables.empty() && !stopped)
    throw BadInput(fmt::format("method '{}' applies to no scenario of suite '{}'", method->info.name, suite.name));
  session.print(tables, {{"search", std::move(rows)}});
  if (!stopped) return kDone;
  std::fputs("tumble: stopped: finished runs are stored; run again to continue\n", stderr);
  return kCheckFailed;
}

}  // namespace

Action declare_search(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<SearchVerbOptions>();
  verb.add("SUITE", options->suite,
           "searches for failures in all scenarios of this suite or suite file, or in this scenario")
      .required()
      .check(a_suite(session));
  verb.add("--scenario", options->scenarios,
           "searches for failures only in this scenario of the suite; repeat the option for more scenarios [default: "
           "all]")
      .one_at_a_time();
  verb.add("--method", options->method, "names the method whose failures are searched").required();
  verb.add("--failure", options->failure,
           "defines a failure: 'METRIC > VALUE' in SI units, or 'METRIC < VALUE' if lower values are worse. A run with "
           "a status other than ok also fails; 'METRIC > inf' counts only such runs");
  verb.add("--worst", options->worst,
           "searches for the simulated run with the worst value of this metric, and estimates no failure probability");
  verb.add("--budget", options->budget, "limits the number of simulated runs of each scenario")
      .whole(1, 10000000)
      .shows_default();
  verb.add("--population", options->population,
           "sets the number of simulated runs per step of the search (population). A larger population gives a "
           "narrower interval of the probability, but needs a larger --budget")
      .whole(4, 100000)
      .shows_default();
  verb.add("--seed", options->seed, "sets the seed of the search; another seed gives an independent estimate")
      .whole(0, 2147483647)
      .shows_default();
  verb.add("--jobs", options->jobs,
           "runs this number of processes in parallel; the result is the same for any number [default: number of "
           "processors]")
      .whole(1, 1024);
  verb.add("--memory", options->memory_mib, "limits the memory of each process, MiB").within(64.0, 1e7).shows_default();
  verb.add("--db", options->database, "stores the runs in this database; runs that are already stored are not repeated")
      .required();
  verb.footer(
      "The search varies only the random parameters of the scenario files and the seed of noise and terrain. See "
      "docs/how_to/search.md.");
  return [&session, options] { return search(session, *options); };
}

}  // namespace tumble::tools
