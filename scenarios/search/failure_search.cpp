// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/failure_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "scenarios/draw/distribution.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/processes/process_pool.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/message.hpp"

namespace tumble::scenarios {

namespace {

struct SearchedRun {
  std::uint64_t seed = 0;
  OutcomeStatus status = OutcomeStatus::ok;
  double value = std::numeric_limits<double>::quiet_NaN();
};

void claim(Results& results, const Scenario& scenario, const Method& method, const FailureGoal& goal,
           const SearchOptions& options) {
  const std::string name = full_name(method.info), key = fmt::format("search {} {}", name, scenario.name);
  std::string text = fmt::format("{}, population {}, search seed {}", goal.text(), options.population, options.seed);
  if (!method.info.version.empty()) text += ", method version " + method.info.version;
  const std::string known = results.note(key);
  if (!known.empty() && known != text)
    throw BadInput(
        fmt::format("the database contains another search of {} on {} ('{}'; this search: '{}'); choose "
                    "another file",
                    name, scenario.name, known, text));
  results.set_note(key, text);
}

class Evaluator {
 public:
  Evaluator(const DataRoot& data, const Scenario& scenario, const Method& method, const FailureGoal& goal,
            Results& results, const SearchOptions& options)
      : data_(data),
        scenario_(scenario),
        method_(method),
        goal_(goal),
        results_(results),
        options_(options),
        numbers_(drawn_numbers(scenario)) {
    read_stored();
  }

  const std::vector<DrawnNumber>& numbers() const { return numbers_; }
  const std::vector<SearchedRun>& runs() const { return runs_; }

  std::vector<double> score(std::span<const SplittingPoint> points) {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t index = runs_.size() + i;
      if (!is_stored(index, points[i].seed())) {
        missing.push_back(i);
      } else if (is_failure(stored_.at(index))) {
        ++failures_;
      }
    }
    execute(points, missing);
    if (options_.stop != nullptr && options_.stop->load()) return {};
    std::vector<double> scores;
    for (std::size_t i = 0; i < points.size(); ++i) {
      runs_.push_back(stored_.at(runs_.size()));
      scores.push_back(goal_.score(runs_.back().status, runs_.back().value));
    }
    return scores;
  }

 private:
  /// Reads the completed runs of an interrupted search from the results database. Runs that the operating system killed
  /// are repeated.
  void read_stored() {
    for (const ScoreRow& row : results_.scores(Rows::curves)) {
      const bool own = row.kind == to_string(method_.info.kind) && row.method == method_.info.name;
      if (row.scenario != scenario_.name || row.setting.key != kSearchRun) continue;
      if (!own && row.status != OutcomeStatus::rejected) continue;
      if (row.status == OutcomeStatus::killed) continue;
      SearchedRun& run = stored_[static_cast<std::size_t>(row.setting.value)];
      run.seed = row.seed;
      run.status = row.status;
      if (row.metric == goal_.metric) run.value = row.value;
    }
  }

  bool is_failure(const SearchedRun& run) const { return goal_.score(run.status, run.value) > goal_.bound(); }

  bool is_stored(std::size_t index, std::uint64_t seed) const {
    const auto at = stored_.find(index);
    return at != stored_.end() && at->second.seed == seed;
  }

  void execute(std::span<const SplittingPoint> points, const std::vector<std::size_t>& missing) {
    std::vector<Scenario> scenarios;
    for (const std::size_t i : missing) scenarios.push_back(scenario_at(scenario_, numbers_, points[i]));
    const auto task_of = [&](std::size_t k) {
      return DrawTask{scenario_.name, &scenarios[k], nullptr, points[missing[k]].seed(), {}, {{&method_, {}}}, {}};
    };
    const double limit_s = options_.timeout_s * (1.0 + kSimulateTimeouts);
    std::size_t done = runs_.size() + points.size() - missing.size();
    report(done);
    run_in_processes(
        missing.size(), limit_s, {options_.jobs, options_.stop},
        [&](std::size_t k, int fd) {
          limit_memory(options_.memory_mib);
          run_draw(data_, task_of(k), options_.timeout_s, fd, true);
        },
        [&](const PooledEnd& ended) {
          take(runs_.size() + missing[ended.index], last_message(task_of(ended.index), ended));
          report(++done);
        });
  }

  void report(std::size_t runs) const {
    if (options_.on_runs) options_.on_runs(runs, failures_);
  }

  void take(std::size_t index, Message message) {
    const Setting setting{kSearchRun, static_cast<double>(index)};
    SearchedRun& run = stored_[index];
    if (message.rejected) {
      message.rejected->setting = setting;
      results_.store(*message.rejected);
      run = {message.rejected->seed, OutcomeStatus::rejected, std::numeric_limits<double>::quiet_NaN()};
      return;
    }
    Outcome& outcome = message.outcome.value();
    outcome.setting = setting;
    results_.store(outcome);
    run = {outcome.seed, outcome.status, value_of(outcome.scores, goal_.metric)};
    failures_ += is_failure(run) ? 1 : 0;
    if (run.status == OutcomeStatus::killed)
      throw BadInput(
          fmt::format("the operating system killed run {} of the search, so the run cannot show whether the method "
                      "fails: {}; run again with more memory or fewer jobs",
                      index, outcome.message));
  }

  /// Returns the result of a process. A process that wrote no result crashed, was killed, or exceeded its time limit.
  static Message last_message(const DrawTask& task, const PooledEnd& ended) {
    std::size_t begin = 0;
    for (std::size_t end; (end = ended.output.find('\n', begin)) != std::string::npos; begin = end + 1) {
      const std::optional<Message> message = from_line(ended.output.substr(begin, end - begin));
      if (message && (message->outcome || message->rejected)) return *message;
    }
    const OutcomeStatus status = ended.late ? OutcomeStatus::timeout : ended_as(ended.end);
    const std::string what = ended.late ? "the simulated run did not end within its time limit"
                                        : "the process that computed the simulated run failed: " + ended.end.describe();
    return {without_answer(task, status, what).front(), {}};
  }

  const DataRoot& data_;
  const Scenario& scenario_;
  const Method& method_;
  const FailureGoal& goal_;
  Results& results_;
  const SearchOptions& options_;
  std::vector<DrawnNumber> numbers_;
  std::map<std::size_t, SearchedRun> stored_;  ///< by index of the run
  std::vector<SearchedRun> runs_;
  std::size_t failures_ = 0;
};

double distance_of(const ScoredPoint& draw) {
  double squares = 0.0;
  for (const double score : draw.point.normals) squares += score * score;
  return std::sqrt(squares);
}

class Report {
 public:
  Report(const Scenario& scenario, const Evaluator& evaluator, double bound, SearchResult& result)
      : scenario_(scenario), evaluator_(evaluator), bound_(bound), result_(result) {}

  void write() {
    for (const ScoredPoint& draw : draws()) result_.failures += draw.score > bound_ ? 1 : 0;
    for (const SearchedRun& run : evaluator_.runs()) result_.rejected += run.status == OutcomeStatus::rejected ? 1 : 0;
    if (draws().empty()) return;
    find_likely();
    std::size_t worst = 0;
    for (std::size_t i = 1; i < draws().size(); ++i) {
      if (key(i) < key(worst)) worst = i;
    }
    result_.worst = found(worst);
    std::vector<ScoredPoint> members;
    for (const std::size_t member : result_.splitting.members) members.push_back(draws()[member]);
    const auto passes = [&](const ScoredPoint& draw) { return !(draw.score > bound_); };
    if (!std::all_of(members.begin(), members.end(), passes)) std::erase_if(members, passes);
    result_.shifts = input_shifts(evaluator_.numbers(), members);
  }

 private:
  const std::vector<ScoredPoint>& draws() const { return result_.splitting.draws; }

  std::pair<double, double> key(std::size_t index) const {
    return {-draws()[index].score, distance_of(draws()[index])};
  }

  FoundFailure found(std::size_t index) const {
    const ScoredPoint& draw = draws()[index];
    const SearchedRun& run = evaluator_.runs()[index];
    return {index,   distance_of(draw), run.status, run.value, scenario_at(scenario_, evaluator_.numbers(), draw.point),
            run.seed};
  }

  void find_likely() {
    std::map<std::size_t, std::size_t> nearest;  // by initial draw
    for (std::size_t i = 0; i < draws().size(); ++i) {
      if (!(draws()[i].score > bound_)) continue;
      const auto [at, added] = nearest.emplace(draws()[i].family, i);
      if (!added && distance_of(draws()[i]) < distance_of(draws()[at->second])) at->second = i;
    }
    for (const auto& [family, index] : nearest) result_.likely.push_back(found(index));
    std::stable_sort(result_.likely.begin(), result_.likely.end(),
                     [](const FoundFailure& a, const FoundFailure& b) { return a.distance < b.distance; });
  }

  const Scenario& scenario_;
  const Evaluator& evaluator_;
  double bound_;
  SearchResult& result_;
};

}  // namespace

std::vector<std::string> stream_names(const Scenario& scenario) {
  std::vector<std::string> out = {sim::kWorldStream};
  for (const Scenario::Sensor& sensor : scenario.sensors) out.push_back(sensor.name);
  return out;
}

Scenario scenario_at(const Scenario& scenario, std::span<const DrawnNumber> numbers, const SplittingPoint& point) {
  Scenario out = scenario;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    fix_number(out, numbers[i].place, number_at(numbers[i].distribution, point.normals[i]));
  const std::vector<std::string> streams = stream_names(scenario);
  for (std::size_t i = 0; i < streams.size(); ++i) out.streams[streams[i]] = point.seeds[i];
  return out;
}

SearchResult search_failures(const DataRoot& data, const Scenario& scenario, const Method& method,
                             const FailureGoal& goal, Results& results, const SearchOptions& options) {
  require_applies(method, scenario);
  require_worker_memory(options.memory_mib);
  draw(data, scenario, options.seed);  // a scenario from which nothing can be drawn is an error, not an outcome
  Evaluator evaluator(data, scenario, method, goal, results, options);
  if (evaluator.numbers().empty())
    throw BadInput(fmt::format("scenario {} has no random parameter, so there is nothing to search", scenario.name));
  claim(results, scenario, method, goal, options);
  SplittingOptions splitting;
  splitting.numbers = evaluator.numbers().size();
  splitting.streams = stream_names(scenario).size();
  splitting.population = options.population;
  splitting.budget = options.budget;
  splitting.bound = goal.bound();
  splitting.seed = options.seed;
  SearchResult result;
  result.splitting = split(splitting, [&](std::span<const SplittingPoint> points) { return evaluator.score(points); });
  Report(scenario, evaluator, goal.bound(), result).write();
  return result;
}

}  // namespace tumble::scenarios
