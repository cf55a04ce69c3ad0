// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep.hpp"

#include <poll.h>

#include <algorithm>
#include <list>
#include <optional>
#include <set>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/data_digest.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kPollMs = 200;
constexpr int kJobsMax = 4096;
constexpr std::uint64_t kSeedsMax = 10'000'000;
// what the simulation of a draw may take beyond its methods, in units of a method's time-out
constexpr double kSimulateTimeouts = 2.0;

struct Worker {
  DrawTask draw;
  Process process;
  double deadline_s;
  std::string buffer;
  bool simulated = false;  // an outcome has come
  bool finished = false;   // said that it is done, or that the draw was rejected
};

std::vector<const Method*> chosen_methods(const Suite& suite) {
  std::vector<const Method*> chosen;
  for (const std::string& name : suite.methods) {
    for (const Method* method : find_methods(name)) {
      if (std::find(chosen.begin(), chosen.end(), method) == chosen.end()) chosen.push_back(method);
    }
  }
  return chosen;
}

/// Of the plain draw and of each one that a curve simulates anew; and what is run on the plain one besides.
struct Settings {
  std::vector<Setting> simulated = {Setting{}};
  std::vector<Setting> shared;
};

Settings settings_of(const Suite& suite) {
  Settings settings;
  for (const Variation& curve : suite.curves) {
    for (const Setting& setting : curve.settings()) {
      (reach(setting) == Reach::simulation ? settings.simulated : settings.shared).push_back(setting);
    }
  }
  return settings;
}

void claim(Results& results, const DataRoot& data, const Suite& suite, const std::filesystem::path& database) {
  const std::string digest = data_digest(data);
  const std::string known = results.note("data");
  if (known.empty()) {
    results.set_note("data", digest);
  } else if (known != digest) {
    throw BadInput(database.string() + ": made from other models or scenarios (digest " + known + ", now " + digest +
                   "); outcomes of two catalogues do not mix: name another file");
  }
  results.set_note("suite", suite.name);
  if (!suite.recordings.empty()) results.set_note("source", kRecordingsSource);
}

class Sweep {
 public:
  Sweep(const DataRoot& data, const Suite& suite, Results& results, const SweepOptions& options)
      : data_(data), suite_(suite), results_(results), options_(options), started_s_(now_s()) {}

  SweepProgress run() {
    const std::vector<const Method*> methods = chosen_methods(suite_);
    if (!suite_.recordings.empty()) recordings_ = find_recordings(suite_.recordings, suite_.recordings_folder);
    for (const std::string& name : suite_.scenarios) scenarios_.push_back(load_scenario(data_, name));
    // a catalogue that cannot be drawn from is the caller's mistake, not an outcome
    for (const Scenario& scenario : scenarios_) draw(data_, scenario, suite_.first_seed);
    plan(methods);
    done_before_ = progress_.draws_done;
    report();
    while (!stopped() && (!pending_.empty() || !workers_.empty())) {
      while (!pending_.empty() && static_cast<int>(workers_.size()) < options_.jobs) start();
      wait_for_words();
      for (auto worker = workers_.begin(); worker != workers_.end();) {
        worker = serve(*worker) ? workers_.erase(worker) : std::next(worker);
      }
      report();
    }
    // what the stopped ones have said already is kept
    for (Worker& worker : workers_) {
      worker.process.read_available(worker.buffer);
      take_lines(worker);
      if (worker.finished) ++progress_.draws_done;
    }
    workers_.clear();
    report();
    return progress_;
  }

 private:
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  using Held = std::set<std::tuple<std::string, std::uint64_t, Kind, std::string, Setting>>;

  void plan_recordings(const std::vector<const Method*>& methods, const Held& held) {
    for (const RecordedDraw& recording : recordings_) {
      require_same_data(recording);
      DrawTask draw{recording.name, nullptr, &recording, kRecordingSeed, {}, {}};
      for (const Method* method : applicable(methods, recording)) {
        if (!held.contains({recording.name, kRecordingSeed, method->info.kind, method->info.name, Setting{}}))
          draw.runs.push_back({method, {}});
      }
      ++progress_.draws_total;
      if (draw.runs.empty())
        ++progress_.draws_done;
      else
        pending_.push_back(std::move(draw));
    }
  }

  /// Rows of a file that has been imported anew do not stand beside those of the old one.
  void require_same_data(const RecordedDraw& recording) const {
    for (const Outcome& row : results_.outcomes(Rows::all)) {
      if (row.scenario != recording.name || row.recording_digest.empty() || row.recording_digest == recording.digest)
        continue;
      throw BadInput(recording.path.string() + ": has digest " + recording.digest +
                     ", the results were made of one with " + row.recording_digest + ": name another database");
    }
  }

  // seeds outermost, so that a sweep that is stopped has all scenarios and all points of the curves in it
  void plan(const std::vector<const Method*>& methods) {
    std::set<std::tuple<std::string, std::uint64_t, Setting>> rejected;
    for (const RejectedDraw& draw : results_.rejected(Rows::all)) {
      rejected.emplace(draw.scenario, draw.seed, draw.setting);
    }
    Held held;
    for (const Outcome& row : results_.outcomes(Rows::all)) {
      held.emplace(row.scenario, row.seed, row.kind, row.method, row.setting);
    }
    plan_recordings(methods, held);
    if (scenarios_.empty()) return;
    const Settings settings = settings_of(suite_);
    for (std::uint64_t seed = suite_.first_seed;; ++seed) {
      for (const Scenario& scenario : scenarios_) {
        const std::vector<const Method*> own = applicable(methods, scenario.robot.type);
        for (const Setting& simulated : settings.simulated) {
          DrawTask draw{scenario.name, &scenario, nullptr, seed, simulated, {}};
          const auto add = [&](const Setting& setting) {
            for (const Method* method : own) {
              const MethodInfo& info = method->info;
              const bool missing = !held.contains({scenario.name, seed, info.kind, info.name, setting});
              if (missing && concerns(setting, info)) draw.runs.push_back({method, setting});
            }
          };
          add(simulated);
          if (simulated.is_plain()) std::for_each(settings.shared.begin(), settings.shared.end(), add);
          ++progress_.draws_total;
          if (draw.runs.empty() || rejected.contains({scenario.name, seed, simulated}))
            ++progress_.draws_done;
          else
            pending_.push_back(std::move(draw));
        }
      }
      if (seed == suite_.last_seed) break;
    }
  }

  void start() {
    DrawTask draw = std::move(pending_.front());
    pending_.pop_front();
    const double limit_s = suite_.timeout_s * (static_cast<double>(draw.runs.size()) + kSimulateTimeouts);
    Process process([&](int fd) { run_draw(data_, draw, suite_.timeout_s, fd); }, true);
    workers_.push_back({std::move(draw), std::move(process), now_s() + limit_s, {}, false, false});
  }

  void wait_for_words() const {
    std::vector<pollfd> waiting;
    for (const Worker& worker : workers_) waiting.push_back({worker.process.read_end(), POLLIN, 0});
    poll(waiting.data(), waiting.size(), kPollMs);
  }

  // stores what the worker has said; true when it has ended
  bool serve(Worker& worker) {
    const bool open = worker.process.read_available(worker.buffer);
    take_lines(worker);
    const bool late = open && now_s() > worker.deadline_s;
    if (open && !late) return false;
    if (late) worker.process.kill();
    const Process::End end = worker.process.wait();
    if (!worker.finished) account_for_death(worker, late, end);
    ++progress_.draws_done;
    return true;
  }

  void take_lines(Worker& worker) {
    std::size_t newline;
    while ((newline = worker.buffer.find('\n')) != std::string::npos) {
      const std::optional<Message> message = from_line(worker.buffer.substr(0, newline));
      worker.buffer.erase(0, newline + 1);
      if (!message) continue;
      if (message->outcome) {
        keep(*message->outcome);
        worker.simulated = true;
        std::erase_if(worker.draw.runs, [&](const DrawTask::Run& run) {
          const MethodInfo& info = run.method->info;
          return info.kind == message->outcome->kind && info.name == message->outcome->method &&
                 run.setting == message->outcome->setting;
        });
      } else if (message->draw) {
        results_.store(*message->draw);
      } else if (message->rejected) {
        keep(*message->rejected);
        worker.finished = true;
      } else {
        worker.finished = true;
      }
    }
  }

  // the process of a draw died: before its first outcome it is the simulation that failed, later the methods left over
  void account_for_death(const Worker& worker, bool late, const Process::End& end) {
    const std::string what = late ? "the draw did not end in time" : "the draw's process " + end.describe();
    if (!worker.simulated) {
      keep(RejectedDraw{worker.draw.name, worker.draw.seed, what, worker.draw.setting});
      return;
    }
    for (const DrawTask::Run& run : worker.draw.runs) {
      Outcome outcome;
      outcome.scenario = worker.draw.name;
      outcome.seed = worker.draw.seed;
      outcome.kind = run.method->info.kind;
      outcome.method = run.method->info.name;
      outcome.setting = run.setting;
      outcome.status = late ? "timeout" : "crashed";
      outcome.message = what;
      keep(outcome);
    }
  }

  void keep(const Outcome& outcome) {
    results_.store(outcome);
    ++progress_.outcomes;
    if (outcome.status != "ok") ++progress_.not_ok;
  }

  void keep(const RejectedDraw& rejected) {
    results_.store(rejected);
    ++progress_.rejected;
  }

  void report() {
    progress_.elapsed_s = now_s() - started_s_;
    const auto done = static_cast<double>(progress_.draws_done - done_before_);
    const auto left = static_cast<double>(progress_.draws_total - progress_.draws_done);
    progress_.left_s = done > 0.0 ? progress_.elapsed_s / done * left : 0.0;
    if (options_.on_progress) options_.on_progress(progress_);
  }

  const DataRoot& data_;
  const Suite& suite_;
  Results& results_;
  const SweepOptions& options_;
  double started_s_;
  std::vector<Scenario> scenarios_;
  std::vector<RecordedDraw> recordings_;
  std::list<DrawTask> pending_;
  std::list<Worker> workers_;
  SweepProgress progress_;
  std::uint64_t done_before_ = 0;
};

}  // namespace

SweepProgress sweep(const DataRoot& data, const Suite& suite, const std::filesystem::path& database,
                    const SweepOptions& options) {
  if (options.jobs < 1 || options.jobs > kJobsMax) {
    throw BadInput("jobs is " + std::to_string(options.jobs) + ", must be within [1, " + std::to_string(kJobsMax) +
                   "]");
  }
  if (suite.last_seed < suite.first_seed) throw BadInput("suite " + suite.name + ": last seed is below the first");
  if (suite.last_seed - suite.first_seed >= kSeedsMax) {
    throw BadInput("suite " + suite.name + ": more than " + std::to_string(kSeedsMax) + " seeds; sweep them in parts");
  }
  Results results(database, Results::Mode::create_or_append);
  claim(results, data, suite, database);
  return Sweep(data, suite, results, options).run();
}

}  // namespace tumble::scenarios
