// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep.hpp"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/external/external_description.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/processes/process_pool.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/recordings/scratch_file.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/sweep_plan.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kJobsMax = 4096;

void claim(Results& results, const DataRoot& data, const Suite& suite, const std::filesystem::path& database) {
  const std::string digest = data_digest(data);
  const std::string known = results.note("data");
  if (known.empty()) {
    results.set_note("data", digest);
  } else if (known != digest) {
    throw BadInput(fmt::format(
        "{}: the results in this file were made from other models or scenarios (digest {}; digest of this run: {}). "
        "Choose another file, because one file cannot contain results of different models or scenarios",
        database.string(), known, digest));
  }
  results.set_note("suite", suite.name);
  if (!suite.recordings.empty()) results.set_note("source", kRecordingsSource);
}

void note_descriptions(Results& results, const Suite& suite) {
  for (const std::string& name : suite.methods) {
    if (!is_method_file(name)) continue;
    const ExternalDescription description = read_external(name);
    results.set_note(description_note(to_string(description.kind), description.name),
                     std::filesystem::absolute(name).lexically_normal().string());
  }
}

void claim_methods(Results& results, std::span<const MethodPointer> methods) {
  for (const MethodPointer& method : methods) {
    if (method->info.version.empty()) continue;
    const std::string key = method_note(method->info.kind, method->info.name);
    const std::string known = results.note(key);
    if (!known.empty() && known != method->info.version)
      throw BadInput(
          fmt::format("the database contains results of another version of {} ('{}'; version of this run: '{}'); "
                      "choose another file or another method name",
                      key, known, method->info.version));
    results.set_note(key, method->info.version);
  }
}

class Sweep {
 public:
  Sweep(const DataRoot& data, const Suite& suite, Results& results, const SweepOptions& options,
        const std::filesystem::path& database)
      : data_(data),
        suite_(suite),
        results_(results),
        options_(options),
        started_s_(now_s()),
        plan_(data, suite, options, database),
        kept_(database) {}

  SweepProgress run() {
    plan_.require_same_recordings(results_);
    claim_methods(results_, plan_.methods());
    note_descriptions(results_, suite_);
    plan_.note_recordings(results_);
    progress_.draws_total = plan_.draws_total();
    try {
      work([&] { return next_draw(); });
    } catch (...) {  // for example a full disk
      discard_unfinished();
      throw;
    }
    if (stopped()) discard_unfinished();
    if (options_.keep.which != Keep::Which::none && !stopped()) update_kept();
    report();
    return progress_;
  }

 private:
  void discard_unfinished() {
    if (options_.keep.which == Keep::Which::none) return;
    try {
      kept_.discard_unfinished();
    } catch (const BadInput& error) {
      progress_.not_kept = error.what();
    }
  }

  using NextDraw = std::function<std::optional<DrawTask>()>;

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  void work(const NextDraw& next) {
    std::map<std::size_t, DrawTask> running;
    std::size_t begun = 0;
    PoolOptions pool{options_.jobs, options_.stop, {}, [this] { report(); }};
    pool.on_output = [&](std::size_t index, std::string& output) { store_results(output, running.at(index)); };
    const auto next_work = [&]() -> std::optional<PooledWork> {
      std::optional<DrawTask> task = next();
      if (!task) return std::nullopt;
      const DrawTask& draw = running[begun++] = std::move(*task);
      const double limit_s = suite_.timeout_s * (static_cast<double>(draw.runs.size()) + kSimulateTimeouts);
      return PooledWork{[this, &draw](int fd) { execute(draw, fd); }, limit_s};
    };
    run_in_processes(next_work, pool, [&](const PooledEnd& ended) {
      const auto draw = running.extract(ended.index);
      progress_.peak_mib = std::max(progress_.peak_mib, ended.end.peak_mib);
      if (!ended.end.normal || !draw.mapped().runs.empty()) account_for_death(draw.mapped(), ended);
      ++progress_.draws_done;
    });
  }

  void execute(const DrawTask& draw, int fd) const {
    limit_memory(options_.memory_mib);
    setenv("TMPDIR", temporary_.path().c_str(), 1);
    run_draw(data_, draw, suite_.timeout_s, fd, options_.recordings_unseen);
  }

  std::optional<DrawTask> next_draw() {
    for (; !plan_.at_end() && !stopped(); plan_.advance()) {
      DrawTask task = plan_.next(results_);
      if (!task.runs.empty()) {
        plan_.advance();
        return task;
      }
      ++progress_.draws_done;
      ++done_before_;
    }
    return std::nullopt;
  }

  /// Stores the results in the complete lines of `output`, and removes these lines from `output`.
  void store_results(std::string& output, DrawTask& draw) {
    for (std::size_t newline; (newline = output.find('\n')) != std::string::npos; output.erase(0, newline + 1)) {
      if (const std::optional<Message> message = from_line(output.substr(0, newline))) take(*message, draw);
    }
  }

  /// Removes the method that has reported a result from the remaining methods of `draw`.
  void take(const Message& message, DrawTask& draw) {
    if (message.outcome) {
      std::erase_if(draw.runs, [&](const DrawTask::Run& run) {
        const MethodInfo& info = run.method->info;
        return info.kind == message.outcome->kind && info.name == message.outcome->method &&
               run.setting == message.outcome->setting;
      });
    }
    if (message.rejected) draw.runs.clear();
    if (message.not_kept) progress_.not_kept = *message.not_kept;
    if (updating_kept_) return;  // the rows exist already
    if (message.outcome) keep(*message.outcome);
    if (message.draw) results_.store(*message.draw);
    if (message.rejected && results_.store(*message.rejected)) ++progress_.rejected;
  }

  // If the worker process of a task dies, each remaining method of the task gets an outcome without scores.
  void account_for_death(const DrawTask& draw, const PooledEnd& ended) {
    const std::string what =
        ended.late ? "the simulated run did not end within its time limit"
                   : fmt::format("the process that computed the simulated run failed: {}", ended.end.describe());
    if (updating_kept_) {
      progress_.not_kept = what;
      return;
    }
    for (const Outcome& outcome : without_answer(draw, ended.late ? OutcomeStatus::timeout : ended_as(ended.end), what))
      keep(outcome);
  }

  void keep(const Outcome& outcome) {
    results_.store(outcome);
    ++progress_.outcomes;
    if (outcome.status != OutcomeStatus::ok) ++progress_.failures[outcome.status];
  }

  void update_kept() {
    updating_kept_ = true;
    const std::set<DrawName> wanted = draws_to_keep(results_, options_.keep);
    std::vector<DrawTask> asked, missing;
    for (const DrawName& draw : wanted) {
      if (plan_.has(draw)) asked.push_back(plan_.again(draw, results_));
    }
    progress_.to_keep = asked.size();
    try {
      for (DrawTask& task : asked) {
        if (!stands(task)) missing.push_back(std::move(task));
      }
      progress_.kept = progress_.to_keep - missing.size();
      kept_.discard_unfinished();
      for (const DrawName& draw : kept_.found()) {
        if (!wanted.contains(draw) && plan_.has(draw)) kept_.remove(draw);
      }
      make_again(missing);
      kept_.discard_unfinished();
    } catch (const BadInput& error) {
      progress_.not_kept = error.what();
    }
  }

  void make_again(const std::vector<DrawTask>& missing) {
    const std::uint64_t draws = progress_.draws_done;
    auto next = missing.begin();
    work([&] { return next == missing.end() ? std::optional<DrawTask>() : *next++; });
    progress_.draws_done = draws;
    for (const DrawTask& task : missing) progress_.kept += stands(task);
  }

  bool stands(const DrawTask& task) const {
    std::vector<Outcome> estimated;
    for (const DrawTask::Run& run : task.runs) {
      Outcome row;
      row.kind = run.method->info.kind;
      row.method = run.method->info.name;
      estimated.push_back(std::move(row));
    }
    return kept_.holds({task.name, task.seed}, estimated);
  }

  void report() {
    progress_.elapsed_s = now_s() - started_s_;
    if (!updating_kept_) {
      const auto done = static_cast<double>(progress_.draws_done - done_before_);
      const auto left = static_cast<double>(progress_.draws_total - progress_.draws_done);
      progress_.left_s = done > 0.0 ? progress_.elapsed_s / done * left : 0.0;
    }
    if (options_.on_progress) options_.on_progress(progress_);
  }

  const DataRoot& data_;
  const Suite& suite_;
  Results& results_;
  const SweepOptions& options_;
  double started_s_;
  SweepPlan plan_;
  KeptDraws kept_;
  const ScratchFolder temporary_{"sweep"};  ///< removed after the processes have ended
  SweepProgress progress_;
  std::uint64_t done_before_ = 0;
  bool updating_kept_ = false;  ///< only write files
};

}  // namespace

std::uint64_t SweepProgress::not_ok() const {
  std::uint64_t count = 0;
  for (const auto& [status, own] : failures) count += own;
  return count;
}

void require_worker_memory(double mib) {
  constexpr double kMinMib = 64.0, kMaxMib = 1e7;
  if (!(mib >= kMinMib && mib <= kMaxMib))
    throw BadInput(fmt::format("the memory limit of a worker process is {} MiB; it must be within [64, 1e7]",
                               std::to_string(mib)));
}

Results open_results(const DataRoot& data, const Suite& suite, const std::filesystem::path& database) {
  Results results(database, Results::Mode::create_or_append);
  claim(results, data, suite, database);
  return results;
}

void require_sound(const Suite& suite, const SweepOptions& options) {
  if (options.jobs < 1 || options.jobs > kJobsMax) {
    throw BadInput(fmt::format("the number of parallel processes (--jobs) is {}; it must be within [1, {}]",
                               options.jobs, kJobsMax));
  }
  require_seeds(suite);
  for (const OutcomeStatus status : options.again) {
    if (!may_run_again(status)) {
      throw BadInput(fmt::format(
          "runs with status '{}' cannot be repeated; only runs with status crashed, timeout or killed can be repeated",
          to_string(status)));
    }
  }
  if (!suite.recordings.empty() && options.keep.which != Keep::Which::none)
    throw BadInput(fmt::format(
        "suite {}: the suite consists of recordings, which exist already as files; set --keep none", suite.name));
  require_worker_memory(options.memory_mib);
}

SweepProgress sweep(const DataRoot& data, const Suite& suite, const DatabaseOwner& database,
                    const SweepOptions& options) {
  require_sound(suite, options);
  Results results = open_results(data, suite, database.database());
  if (options.keep.which != Keep::Which::none) results.set_note(kKeepNote, to_string(options.keep));
  return Sweep(data, suite, results, options, database.database()).run();
}

}  // namespace tumble::scenarios
