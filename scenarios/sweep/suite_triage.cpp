// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/suite_triage.hpp"

#include <fmt/format.h>

#include <map>
#include <new>
#include <optional>

#include "scenarios/processes/process.hpp"
#include "scenarios/processes/process_pool.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr char kBetween = '\t';  // names contain no tab

void report_rows(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                 const SuiteTriageOptions& options, int fd) {
  const auto report_trouble = [&](const std::string& why) {
    write_all(fd, std::string(1, kBetween) + one_line(why) + "\n");
  };
  limit_memory(options.memory_mib);
  TriageOptions telling = options.triage;
  telling.on_run = nullptr;
  telling.on_row = [&](const TriageRow& row) { write_all(fd, row.input + kBetween + to_line({row.outcome, {}})); };
  try {
    triage(data, scenario, seed, method, telling);
    write_all(fd, "\n");
  } catch (const std::bad_alloc&) {
    report_trouble("there is not enough memory for the method; free memory or increase the memory limit of a process");
  } catch (const std::exception& error) {
    report_trouble(error.what());
  }
}

std::string doc_of(const std::string& input) {
  for (const TrueInput& each : true_inputs()) {
    if (each.name == input) return each.doc;
  }
  return "unchanged recording";
}

bool read_rows(const std::string& text, const FailureGoal& failure, DrawTriage& out) {
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    if (line.empty()) return true;
    const std::size_t between = line.find(kBetween);
    if (between == 0) {
      out.error_code = line.substr(1);
      return true;
    }
    if (between == std::string::npos) return false;
    const std::optional<Message> message = from_line(line.substr(between + 1));
    if (!message || !message->outcome) return false;
    const std::string input = line.substr(0, between);
    out.rows.push_back({input, doc_of(input), *message->outcome, failure.holds(*message->outcome)});
  }
  return false;
}

void conclude(const PooledEnd& ended, const FailureGoal& failure, DrawTriage& draw) {
  if (read_rows(ended.output, failure, draw)) return;
  draw.error_code = ended.late
                        ? "the simulated run did not end within its time limit"
                        : fmt::format("the process that computed the simulated run failed: {}", ended.end.describe());
}

}  // namespace

std::vector<DrawName> draws_of(const DataRoot& data, const Suite& suite, const Method& method) {
  std::vector<std::string> names;
  for (const std::string& name : suite.scenarios) {
    if (method.info.applies_to(subject_of(load_scenario(data, name)))) names.push_back(name);
  }
  require_seeds(suite);
  std::vector<DrawName> out;
  for (std::uint64_t seed = suite.first_seed; !names.empty(); ++seed) {
    for (const std::string& name : names) {
      if (suite.has_draw(name, seed)) out.push_back({name, seed});
    }
    if (seed == suite.last_seed) break;
  }
  return out;
}

std::set<DrawName> failed_draws(const Results& results, const Method& method, const FailureGoal& failure) {
  std::set<DrawName> out;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (row.kind != method.info.kind || row.method != method.info.name) return;
    Outcome outcome;
    outcome.status = row.status;
    for (const OutcomeView::Value& score : row.scores) outcome.scores.push_back({*score.metric, score.value});
    if (failure.holds(outcome)) out.insert({std::string(row.scenario), row.seed});
  });
  return out;
}

std::vector<DrawTriage> triage_draws(const DataRoot& data, std::span<const DrawName> draws, const Method& method,
                                     const SuiteTriageOptions& options) {
  require_worker_memory(options.memory_mib);
  std::map<std::string, Scenario> scenarios;
  for (const DrawName& draw : draws) {
    if (!scenarios.contains(draw.scenario)) scenarios.emplace(draw.scenario, load_scenario(data, draw.scenario));
  }
  const double draw_s =
      options.triage.timeout_s * (static_cast<double>(true_inputs().size()) + 1.0 + kSimulateTimeouts);
  std::vector<DrawTriage> all(draws.size());
  std::vector<bool> done(draws.size(), false);
  const auto work = [&](std::size_t index, int fd) {
    const DrawName& draw = draws[index];
    report_rows(data, scenarios.at(draw.scenario), draw.seed, method, options, fd);
  };
  run_in_processes(draws.size(), draw_s, {options.jobs, options.stop}, work, [&](const PooledEnd& ended) {
    DrawTriage& draw = all[ended.index];
    draw.draw = draws[ended.index];
    conclude(ended, options.triage.failure, draw);
    done[ended.index] = true;
    if (options.on_draw) options.on_draw(draw);
  });
  std::vector<DrawTriage> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (done[i]) out.push_back(std::move(all[i]));
  }
  return out;
}

}  // namespace tumble::scenarios
