// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep.hpp"

#include <poll.h>

#include <algorithm>
#include <list>
#include <optional>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kPollMs = 200;
constexpr int kJobsMax = 4096;
constexpr std::uint64_t kSeedsMax = 10'000'000;
// what the simulation of a draw may take beyond its methods, in units of a method's time-out
constexpr double kSimulateTimeouts = 2.0;

// of a method's time-out: by then a command of somebody else's is ended by what knows all that it has started
constexpr double kOwnShare = 0.9;

struct Worker {
  DrawTask draw;
  Process process;
  double deadline_s;
  std::string buffer;
  bool finished = false;  // said that it is done, or that the draw was rejected
};

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

/// So that each run can be asked for once more (run_again.hpp), whatever folder it is asked from.
void note_descriptions(Results& results, const Suite& suite) {
  for (const std::string& name : suite.methods) {
    if (!name.ends_with(".yaml")) continue;
    const ExternalDescription description = read_external(name);
    results.set_note(description_note(to_string(description.kind), description.name),
                     std::filesystem::absolute(name).lexically_normal().string());
  }
}

/// Rows of two versions of somebody else's method do not stand under one name.
void claim_methods(Results& results, std::span<const MethodPointer> methods) {
  for (const MethodPointer& method : methods) {
    if (method->info.version.empty()) continue;
    const std::string key = method_note(method->info.kind, method->info.name);
    const std::string known = results.note(key);
    if (!known.empty() && known != method->info.version)
      throw BadInput("the database holds rows of another " + key + " ('" + known + "', now '" + method->info.version +
                     "'): name another file, or another method");
    results.set_note(key, method->info.version);
  }
}

class Sweep {
 public:
  Sweep(const DataRoot& data, const Suite& suite, Results& results, const SweepOptions& options)
      : data_(data),
        suite_(suite),
        results_(results),
        options_(options),
        started_s_(now_s()),
        settings_(settings_of(suite)),
        methods_(find_methods_within(suite.methods, kOwnShare * suite.timeout_s)) {
    next_.seed = suite.first_seed;
  }

  SweepProgress run() {
    for (const std::string& name : suite_.scenarios) add_scenario(name);
    if (!suite_.recordings.empty()) add_recordings();
    const auto idle = [](const auto& each) { return each.methods.empty(); };
    if (std::all_of(scenarios_.begin(), scenarios_.end(), idle) &&
        std::all_of(recordings_.begin(), recordings_.end(), idle)) {
      throw BadInput("suite " + suite_.name + ": none of its methods applies to any of its scenarios");
    }
    claim_methods(results_, methods_);
    note_descriptions(results_, suite_);
    // a catalogue that cannot be drawn from is the caller's mistake, not an outcome
    for (const Planned& each : scenarios_) draw(data_, each.scenario, suite_.first_seed);
    const std::uint64_t seeds = suite_.last_seed - suite_.first_seed + 1;
    progress_.draws_total = recordings_.size() + seeds * scenarios_.size() * settings_.simulated.size();
    next_.at_end = scenarios_.empty();
    while (!stopped()) {
      while (!stopped() && static_cast<int>(workers_.size()) < options_.jobs && start_next()) {
      }
      report();
      if (workers_.empty()) break;
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
  /// A scenario of the suite and the methods that apply to it.
  struct Planned {
    Scenario scenario;
    std::vector<MethodPointer> methods;
  };

  /// A recording of the suite and the methods that apply to it.
  struct Recorded {
    RecordedDraw recording;
    std::vector<MethodPointer> methods;
  };

  /// The draw that comes next: recordings first, then seeds, which are outermost, so that a sweep that is stopped has
  /// all scenarios and all points of the curves in it.
  struct Cursor {
    std::size_t recording = 0;
    std::uint64_t seed = 0;
    std::size_t scenario = 0, setting = 0;
    bool at_end = false;  ///< of the seeds
  };

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  void add_scenario(const std::string& name) {
    Planned planned{load_scenario(data_, name), {}};
    planned.methods = applicable(methods_, planned.scenario.robot.type);
    scenarios_.push_back(std::move(planned));
  }

  void add_recordings() {
    for (RecordedDraw& recording : find_recordings(suite_.recordings, suite_.recordings_folder)) {
      require_same_data(recording);
      results_.set_note(recording_note(recording.name),
                        std::filesystem::absolute(recording.path).lexically_normal().string());
      std::vector<MethodPointer> own = applicable(methods_, recording);
      recordings_.push_back({std::move(recording), std::move(own)});
    }
  }

  /// Rows of a file that has been imported anew do not stand beside those of the old one.
  void require_same_data(const RecordedDraw& recording) const {
    for (const Outcome& row : results_.outcomes_of(recording.name, kRecordingSeed)) {
      if (row.recording_digest.empty() || row.recording_digest == recording.digest) continue;
      throw BadInput(recording.path.string() + ": has digest " + recording.digest +
                     ", the results were made of one with " + row.recording_digest + ": name another database");
    }
  }

  bool nothing_left() const { return next_.recording == recordings_.size() && next_.at_end; }

  void advance() {
    if (next_.recording < recordings_.size()) {
      ++next_.recording;
      return;
    }
    if (++next_.setting < settings_.simulated.size()) return;
    next_.setting = 0;
    if (++next_.scenario < scenarios_.size()) return;
    next_.scenario = 0;
    next_.at_end = next_.seed == suite_.last_seed;
    ++next_.seed;
  }

  /// Adds to the task what has no row yet with `setting`, or one that is to be run again.
  void add_missing(const std::vector<MethodPointer>& methods, const std::vector<Outcome>& held, const Setting& setting,
                   DrawTask& task) const {
    const auto stands = [&](const MethodInfo& info) {
      return std::any_of(held.begin(), held.end(), [&](const Outcome& row) {
        return row.kind == info.kind && row.method == info.name && row.setting == setting &&
               std::find(options_.again.begin(), options_.again.end(), row.status) == options_.again.end();
      });
    };
    for (const MethodPointer& method : methods) {
      if (concerns(setting, method->info) && !stands(method->info)) task.runs.push_back({method.get(), setting});
    }
  }

  DrawTask task_at_cursor() const {
    if (next_.recording < recordings_.size()) {
      const Recorded& recorded = recordings_[next_.recording];
      DrawTask task{recorded.recording.name, nullptr, &recorded.recording, kRecordingSeed, {}, {}};
      add_missing(recorded.methods, results_.outcomes_of(task.name, task.seed), {}, task);
      return task;
    }
    const Planned& planned = scenarios_[next_.scenario];
    const Setting& simulated = settings_.simulated[next_.setting];
    DrawTask task{planned.scenario.name, &planned.scenario, nullptr, next_.seed, simulated, {}};
    for (const RejectedDraw& rejected : results_.rejected_of(task.name, task.seed)) {
      if (rejected.setting == simulated) return task;
    }
    const std::vector<Outcome> held = results_.outcomes_of(task.name, task.seed);
    add_missing(planned.methods, held, simulated, task);
    if (!simulated.is_plain()) return task;
    for (const Setting& setting : settings_.shared) add_missing(planned.methods, held, setting, task);
    return task;
  }

  // starts the next draw that has something to run; false when there is none, or no process can be made to run it in
  bool start_next() {
    for (; !nothing_left() && !stopped(); advance()) {
      DrawTask task = task_at_cursor();
      if (task.runs.empty()) {
        ++progress_.draws_done;
        ++done_before_;
        continue;
      }
      if (!start(std::move(task))) return false;
      advance();
      return true;
    }
    return false;
  }

  bool start(DrawTask task) {
    const double limit_s = suite_.timeout_s * (static_cast<double>(task.runs.size()) + kSimulateTimeouts);
    try {
      Process process([&](int fd) { run_draw(data_, task, suite_.timeout_s, fd); }, true);
      workers_.push_back({std::move(task), std::move(process), now_s() + limit_s, {}, false});
    } catch (const std::system_error& error) {
      if (workers_.empty()) throw BadInput(std::string("no process can be made: ") + error.what());
      return false;  // when one of the others has ended
    }
    return true;
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

  // the process of a draw died: what is left over of its runs has no answer
  void account_for_death(const Worker& worker, bool late, const Process::End& end) {
    const std::string what = late ? "the draw did not end in time" : "the draw's process " + end.describe();
    for (const Outcome& outcome : without_answer(worker.draw, late ? OutcomeStatus::timeout : ended_as(end), what))
      keep(outcome);
  }

  void keep(const Outcome& outcome) {
    results_.store(outcome);
    ++progress_.outcomes;
    if (outcome.status != OutcomeStatus::ok) ++progress_.not_ok;
  }

  void keep(const RejectedDraw& rejected) {
    if (results_.store(rejected)) ++progress_.rejected;
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
  Settings settings_;
  const std::vector<MethodPointer> methods_;
  std::vector<Planned> scenarios_;
  std::vector<Recorded> recordings_;
  Cursor next_;
  std::list<Worker> workers_;
  SweepProgress progress_;
  std::uint64_t done_before_ = 0;
};

}  // namespace

Results open_results(const DataRoot& data, const Suite& suite, const std::filesystem::path& database) {
  Results results(database, Results::Mode::create_or_append);
  claim(results, data, suite, database);
  return results;
}

SweepProgress sweep(const DataRoot& data, const Suite& suite, const std::filesystem::path& database,
                    const SweepOptions& options) {
  return sweep(data, suite, DatabaseOwner(database), options);
}

SweepProgress sweep(const DataRoot& data, const Suite& suite, const DatabaseOwner& database,
                    const SweepOptions& options) {
  if (options.jobs < 1 || options.jobs > kJobsMax) {
    throw BadInput("jobs is " + std::to_string(options.jobs) + ", must be within [1, " + std::to_string(kJobsMax) +
                   "]");
  }
  if (suite.last_seed < suite.first_seed) throw BadInput("suite " + suite.name + ": last seed is below the first");
  if (suite.last_seed - suite.first_seed >= kSeedsMax) {
    throw BadInput("suite " + suite.name + ": more than " + std::to_string(kSeedsMax) + " seeds; sweep them in parts");
  }
  for (const OutcomeStatus status : options.again) {
    if (!may_run_again(status)) {
      throw BadInput(std::string("'") + to_string(status) + "' is not run again; what may be: crashed timeout killed");
    }
  }
  Results results = open_results(data, suite, database.database());
  return Sweep(data, suite, results, options).run();
}

}  // namespace tumble::scenarios
