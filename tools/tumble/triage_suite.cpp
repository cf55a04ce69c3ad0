// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/triage_suite.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>

#include "scenarios/errors.hpp"
#include "scenarios/summary/input_worth.hpp"
#include "scenarios/sweep/sweep_notes.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/interrupt.hpp"

namespace tumble::tools {

namespace {

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
  const std::string failures = first->failed == 0 ? "no method run failed (--metric and --limit define a failure)"
                                                  : "replacing a single input by its true value prevents no failure";
  if (first->better <= first->worse)
    return fmt::format("{}; no replacement of an input by its true value improves more simulated runs than it worsens",
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
  return cures.empty() ? fmt::format("{}fails, and no true value of a single input prevents the failure", name)
                       : fmt::format("{}fails; the true values of these inputs prevent the failure: {}", name, cures);
}

std::string first_trouble(const std::vector<DrawTriage>& draws) {
  const auto first =
      std::find_if(draws.begin(), draws.end(), [](const DrawTriage& draw) { return !draw.error_code.empty(); });
  return first == draws.end() ? "" : line_of(*first);
}

}  // namespace

int run_suite_triage(const Session& session, SuiteTriage asked) {
  if (!asked.suite.recordings.empty())
    throw BadInput(fmt::format("suite '{}' contains recordings, whose inputs cannot be replaced by their true values",
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

}  // namespace tumble::tools
