// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/gate_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "scenarios/cases/hold_case.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tools/tumble/gate_database.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/sweeping.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::CaseResult;

scenarios::Suite suite_of(const scenarios::Scenario& named) {
  scenarios::Suite suite;
  suite.name = kAllCases;
  suite.doc = named.doc;
  suite.scenarios = {named.name};
  suite.first_seed = suite.last_seed = named.named_case->seed;
  for (const scenarios::Expectation& expected : named.named_case->expected) suite.methods.push_back(expected.method);
  return suite;
}

using Reached = std::vector<std::pair<scenarios::Expectation, scenarios::Outcome>>;

Reached reached(const scenarios::Results& results, const scenarios::Scenario& named) {
  Reached out;
  const std::vector<scenarios::ScoreRow> scores = results.scores();
  for (const scenarios::Expectation& expected : named.named_case->expected) {
    const scenarios::MethodInfo& method = scenarios::find_methods(expected.method).front()->info;
    for (scenarios::Outcome& outcome : results.outcomes_of(named.name, named.named_case->seed)) {
      if (outcome.kind != method.kind || outcome.method != method.name || !outcome.setting.is_plain()) continue;
      for (const scenarios::ScoreRow& row : scores) {
        const bool own = row.scenario == outcome.scenario && row.seed == outcome.seed && row.method == outcome.method &&
                         row.kind == to_string(outcome.kind) && !row.metric.empty();
        if (own) outcome.scores.push_back({row.metric, row.value});
      }
      out.emplace_back(expected, std::move(outcome));
    }
  }
  if (out.size() != named.named_case->expected.size())
    throw scenarios::BadInput(fmt::format(
        "the run of named case {} cannot be simulated, so results are missing; correct or delete the file of the case",
        named.name));
  return out;
}

std::string number_or_nothing(const std::optional<double>& value) {
  return value ? number_text(*value) : "";
}

Table table_of(const std::vector<CaseResult>& results) {
  Table table("", {"case", "method", "expected", "metric", "accepted", "now", "status", "verdict"});
  for (const CaseResult& result : results) {
    table.add_row({result.name, result.method, result.expected.fails ? "fails" : "holds", result.expected.metric,
                   number_or_nothing(result.expected.value), number_or_nothing(result.value), to_string(result.status),
                   result.fault.empty() ? "pass" : "FAIL: " + result.fault});
  }
  return table;
}

json to_json(const std::vector<CaseResult>& results, bool passes) {
  const auto number = [](const std::optional<double>& value) { return value ? json(*value) : json(); };
  json rows = json::array();
  for (const CaseResult& result : results) {
    rows.push_back({{"case", result.name},
                    {"method", result.method},
                    {"expected", result.expected.fails ? "fails" : "holds"},
                    {"metric", result.expected.metric},
                    {"accepted", number(result.expected.value)},
                    {"value", number(result.value)},
                    {"status", to_string(result.status)},
                    {"better", result.better},
                    {"fault", result.fault},
                    {"verdict", result.fault.empty() ? "pass" : "fail"}});
  }
  return {{"verdict", passes ? "pass" : "fail"}, {"cases", std::move(rows)}};
}

void accept(const Session& session, const scenarios::DataRoot& data, scenarios::Scenario named, Reached& outcomes) {
  named.named_case->expected.clear();
  for (auto& [expected, outcome] : outcomes) {
    if (outcome.status == scenarios::OutcomeStatus::killed)
      throw scenarios::BadInput(
          fmt::format("{}, {}: the operating system killed the run, so the outcome cannot be accepted; free memory and "
                      "run again. Message of the run: {}",
                      named.name, expected.method, outcome.message));
    expected = scenarios::accepted(expected, outcome);
    named.named_case->expected.push_back(expected);
  }
  const std::filesystem::path file = data.regressions() / (named.name + ".yaml");
  scenarios::replace_file(file, scenarios::to_yaml(named));
  session.note("accepted: " + file.string());
}

std::vector<scenarios::Scenario> cases_of(const scenarios::DataRoot& data, const std::string& word) {
  std::vector<scenarios::Scenario> out;
  for (const std::string& name : scenarios::case_names(data)) {
    if (word != kAllCases && word != name) continue;
    out.push_back(scenarios::load_scenario(data, name));
    scenarios::require_known(out.back());
  }
  if (out.empty())
    throw scenarios::BadInput(fmt::format("{}: this folder contains no named case; 'tumble shrink' writes named cases",
                                          data.regressions().string()));
  return out;
}

}  // namespace

bool names_cases(const scenarios::DataRoot& data, const std::string& word) {
  const std::vector<std::string> names = scenarios::case_names(data);
  return word == kAllCases || std::binary_search(names.begin(), names.end(), word);
}

std::function<void(const std::string&)> a_suite_or_cases(const Session& session) {
  return [&session](const std::string& text) {
    if (!names_cases(session.data(), text)) scenarios::load_suite(session.data(), text);
  };
}

int hold_cases(const Session& session, const scenarios::DataRoot& data, const CaseGate& gate) {
  const std::vector<scenarios::Scenario> cases = cases_of(data, gate.word);
  const GateDatabase database(gate.database);
  const scenarios::DatabaseOwner owner(database.path());
  const InterruptFlag interrupt;
  scenarios::SweepOptions how;
  how.jobs = gate.jobs;
  how.stop = &interrupt.raised();
  for (const scenarios::Scenario& named : cases) {
    session.note(named.name + ": " + named.doc);
    const scenarios::SweepProgress progress = sweep_with_progress(session, data, suite_of(named), owner, how);
    if (progress.draws_done < progress.draws_total) return say_stopped(progress);
  }
  const scenarios::Results results(database.path(), scenarios::Results::Mode::read_only);
  std::vector<CaseResult> held;
  for (const scenarios::Scenario& named : cases) {
    Reached outcomes = reached(results, named);
    if (gate.accept) accept(session, data, named, outcomes);
    for (const auto& [expected, outcome] : outcomes)
      held.push_back(scenarios::hold_case(named.name, expected, outcome));
  }
  const bool passes = std::all_of(held.begin(), held.end(), [](const CaseResult& each) { return each.fault.empty(); });
  session.print({table_of(held)}, to_json(held, passes));
  return passes ? kDone : kCheckFailed;
}

}  // namespace tumble::tools
