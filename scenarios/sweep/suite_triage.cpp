// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/suite_triage.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <list>
#include <map>
#include <new>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
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

bool read_rows(const std::string& text, const Failure& failure, DrawTriage& out) {
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

struct Worker {
  std::size_t index;  ///< index of the simulated run
  double deadline_s;  ///< deadline as a time of now_s()
  Process process;
  std::string said;
};

void conclude(Worker& worker, bool late, const Failure& failure, DrawTriage& draw) {
  if (late) worker.process.kill();
  const Process::End end = worker.process.wait();
  if (read_rows(worker.said, failure, draw)) return;
  draw.error_code = late ? "the simulated run did not end within its time limit"
                         : fmt::format("the process that computed the simulated run failed: {}", end.describe());
}

bool begin(std::list<Worker>& workers, std::size_t index, double deadline_s, const std::function<void(int)>& work) {
  try {
    workers.push_back({index, deadline_s, Process(work, true), {}});
    return true;
  } catch (const std::system_error& error) {
    if (workers.empty()) throw BadInput(fmt::format("cannot start a worker process: {}", error.what()));
    return false;
  }
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

std::set<DrawName> failed_draws(const Results& results, const Method& method, const Failure& failure) {
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
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  std::vector<DrawTriage> all(draws.size());
  std::vector<bool> done(draws.size(), false);
  std::list<Worker> workers;
  std::size_t next = 0;
  while (!stopped() && (next < draws.size() || !workers.empty())) {
    while (next < draws.size() && workers.size() < static_cast<std::size_t>(options.jobs)) {
      const DrawName& draw = draws[next];
      const Scenario& scenario = scenarios.at(draw.scenario);
      const auto work = [&](int fd) { report_rows(data, scenario, draw.seed, method, options, fd); };
      if (!begin(workers, next, now_s() + draw_s, work)) break;
      all[next++].draw = draw;
    }
    std::vector<pollfd> waiting;
    for (const Worker& worker : workers) waiting.push_back({worker.process.read_end(), POLLIN, 0});
    poll(waiting.data(), waiting.size(), kPollMs);
    for (auto worker = workers.begin(); worker != workers.end();) {
      const bool open = worker->process.read_available(worker->said);
      const bool late = open && now_s() > worker->deadline_s;
      if (open && !late) {
        ++worker;
        continue;
      }
      DrawTriage& draw = all[worker->index];
      conclude(*worker, late, options.triage.failure, draw);
      done[worker->index] = true;
      if (options.on_draw) options.on_draw(draw);
      worker = workers.erase(worker);
    }
  }
  std::vector<DrawTriage> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (done[i]) out.push_back(std::move(all[i]));
  }
  return out;
}

}  // namespace tumble::scenarios
