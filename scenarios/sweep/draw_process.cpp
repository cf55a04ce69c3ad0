// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_process.hpp"

#include <malloc.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/scratch_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/variation.hpp"
#include "scenarios/text.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/simulate.hpp"

namespace tumble::scenarios {

namespace {

double resident_mib() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMib;
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string leave_estimate(const Method& method, const SimulatedDraw& draw, const Estimate& estimate,
                           const std::filesystem::path& folder) {
  if (folder.empty()) return {};
  try {
    std::filesystem::create_directories(folder);
    write_estimate(folder, method.info.name, method.info.kind, estimate, digest(draw.recording.sensors, nullptr));
    return {};
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return one_line(error.what());
  }
}

void run_method_child(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                      const sim::Surface* surface, const std::filesystem::path& folder, int fd) {
  const double before_mib = resident_mib();
  Outcome outcome;
  const Estimate estimate = run_method(method, draw, outcome);
  // Peak memory is recorded only for built-in methods. For an external command, the operating system also counts the
  // memory of the forked process.
  const bool own = method.info.version.empty();
  if (own) outcome.scores.push_back({"estimate_peak_mib", std::max(0.0, peak_mib() - before_mib)});
  assess(method, scored, surface, estimate, outcome);
  const std::string not_kept = leave_estimate(method, draw, estimate, folder);
  if (!not_kept.empty()) write_all(fd, to_line({{}, {}, {}, not_kept}));
  write_all(fd, to_line({outcome, {}}));
}

bool read_until(Process& process, double deadline_s, std::string& buffer) {
  while (true) {
    const double left_s = deadline_s - now_s();
    if (left_s <= 0.0) return false;
    pollfd waiting{process.read_end(), POLLIN, 0};
    poll(&waiting, 1, static_cast<int>(std::ceil(std::min(left_s, 1.0) * 1e3)));
    if (!process.read_available(buffer)) return true;
  }
}

/// Returns true if a method needs lidar data. External methods receive all sensor data, so an external method needs
/// lidar data unless its kind is `rate`.
bool reads_lidars(const MethodInfo& info) {
  return info.kind == Kind::slam || (info.kind != Kind::rate && !info.version.empty());
}

Lidars lidars_for(const DrawTask& task, bool recordings_unseen) {
  const bool kept = task.keeping.when != Keeping::When::never && task.keeping.lidars;
  const bool read =
      kept || std::any_of(task.runs.begin(), task.runs.end(), [&](const DrawTask::Run& run) {
        const MethodInfo& info = run.method->info;
        return needs_lidar(run.setting) || (recordings_unseen ? reads_lidars(info) : info.kind != Kind::rate);
      });
  return read ? Lidars::simulated : Lidars::left_out;
}

struct Given {
  Setting setting;
  std::optional<SimulatedDraw> draw, scored;
};

Given changed(const SimulatedDraw& draw, const Setting& setting) {
  Given given{setting, {}, {}};
  if (reach(setting) != Reach::input) return given;
  given.draw = with_setting(draw, setting);
  given.scored = scored_by(draw, *given.draw);
  return given;
}

Outcome unanswered(const DrawTask& task, const DrawTask::Run& run, OutcomeStatus status, const std::string& message) {
  Outcome outcome;
  outcome.scenario = task.name;
  outcome.seed = task.seed;
  outcome.kind = run.method->info.kind;
  outcome.method = run.method->info.name;
  outcome.setting = run.setting;
  outcome.status = status;
  outcome.message = one_line(message);
  return outcome;
}

void reject(const DrawTask& task, const std::exception& error, int fd) {
  write_all(fd, to_line({{}, RejectedDraw{task.name, task.seed, one_line(error.what()), task.setting}}));
}

void give_up(const DrawTask& task, OutcomeStatus status, const std::string& message, int fd) {
  for (const Outcome& outcome : without_answer(task, status, message)) write_all(fd, to_line({outcome, {}}));
}

struct MadeDraw {
  SimulatedDraw draw;
  std::optional<sim::Surface> surface;
};

std::unique_ptr<MadeDraw> make(const DataRoot& data, const DrawTask& task, bool recordings_unseen) {
  auto made = std::make_unique<MadeDraw>();
  made->draw = task.recording != nullptr ? read_draw(*task.recording)
                                         : simulate_draw(data, with_setting(*task.scenario, task.setting), task.seed, 1,
                                                         lidars_for(task, recordings_unseen));
  const bool maps = std::any_of(task.runs.begin(), task.runs.end(),
                                [](const DrawTask::Run& run) { return run.method->info.kind == Kind::slam; });
  if (maps && made->draw.built) made->surface.emplace(*made->draw.built);
  return made;
}

DrawValues motion_of(const DrawTask& task, const sim::Recording& recording) {
  const bool whole = task.recording == nullptr || task.recording->simulated;
  DrawValues values =
      whole ? motion_values(task.name, task.seed, recording) : recorded_motion_values(task.name, task.seed, recording);
  values.setting = task.setting;
  return values;
}

std::unique_ptr<MadeDraw> made_draw(const DataRoot& data, const DrawTask& task, int fd, bool recordings_unseen) {
  try {
    std::unique_ptr<MadeDraw> made = make(data, task, recordings_unseen);
    write_all(fd, to_line({{}, {}, motion_of(task, made->draw.recording)}));
    return made;
  } catch (const BadInput& error) {
    reject(task, error, fd);
  } catch (const sim::InvalidSituation& error) {
    reject(task, error, fd);
  } catch (const sim::SimulationFailure& error) {
    reject(task, error, fd);
  } catch (const std::bad_alloc&) {
    give_up(task, OutcomeStatus::killed,
            "there is not enough memory to simulate the run; free memory or increase the memory limit of a process",
            fd);
  } catch (const std::exception& error) {
    give_up(task, OutcomeStatus::crashed, std::string("simulation error: ") + error.what(), fd);
  }
  return nullptr;
}

Outcome run_one(const DrawTask& task, const DrawTask::Run& run, const MadeDraw& made, double timeout_s, Given& given,
                DrawFiles& files) {
  Outcome outcome;
  std::string not_kept;
  try {
    if (run.setting != given.setting) given = changed(made.draw, run.setting);
    outcome =
        run_isolated(with_setting(*run.method, run.setting), given.draw ? *given.draw : made.draw,
                     given.scored ? *given.scored : made.draw, made.surface ? &*made.surface : nullptr, timeout_s,
                     run.setting.is_plain() ? files.estimate(run.method->info) : std::filesystem::path(), &not_kept);
    if (!not_kept.empty()) files.miss(not_kept);
  } catch (const std::bad_alloc&) {
    outcome =
        unanswered(task, run, OutcomeStatus::killed,
                   "there is not enough memory for the method; free memory or increase the memory limit of a process");
  } catch (const std::system_error& error) {
    outcome = unanswered(task, run, OutcomeStatus::killed, error.what());
  }
  outcome.setting = run.setting;
  return outcome;
}

}  // namespace

OutcomeStatus ended_as(const Process::End& end) {
  return end.killed() ? OutcomeStatus::killed : OutcomeStatus::crashed;
}

Outcome run_isolated(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                     const sim::Surface* surface, double timeout_s, const std::filesystem::path& folder,
                     std::string* not_kept) {
  const double before_mib = resident_mib();
  const ScratchFolder temporary("run");
  Process process(
      [&](int fd) {
        setenv("TMPDIR", temporary.path().c_str(), 1);
        run_method_child(method, draw, scored, surface, folder, fd);
      },
      false);
  std::string text;
  const bool in_time = read_until(process, now_s() + timeout_s, text);
  if (!in_time) process.kill();
  const Process::End end = process.wait();
  std::size_t begin = 0;
  for (std::size_t newline; (newline = text.find('\n', begin)) != std::string::npos; begin = newline + 1) {
    const std::optional<Message> message = from_line(text.substr(begin, newline - begin));
    if (message && message->not_kept && not_kept != nullptr) *not_kept = *message->not_kept;
    if (message && message->outcome) return *message->outcome;
  }

  Outcome outcome;
  outcome.scenario = draw.scenario;
  outcome.seed = draw.seed;
  outcome.kind = method.info.kind;
  outcome.method = method.info.name;
  outcome.recording_digest = draw.recording_digest;
  outcome.status = in_time ? ended_as(end) : OutcomeStatus::timeout;
  outcome.message = in_time ? end.describe() : "no answer within " + std::to_string(timeout_s) + " s";
  outcome.scores = {{"estimate_cpu_s", end.cpu_s},
                    {"estimate_peak_mib", std::max(0.0, end.peak_mib - before_mib)},
                    {"simulate_cpu_s", draw.simulate_cpu_s}};
  return outcome;
}

std::vector<Outcome> without_answer(const DrawTask& task, OutcomeStatus status, const std::string& message) {
  std::vector<Outcome> outcomes;
  for (const DrawTask::Run& run : task.runs) outcomes.push_back(unanswered(task, run, status, message));
  return outcomes;
}

void run_draw(const DataRoot& data, const DrawTask& task, double timeout_s, int fd, bool recordings_unseen) {
  const std::unique_ptr<const MadeDraw> made = made_draw(data, task, fd, recordings_unseen);
  if (!made) return;
  // malloc_trim() returns the freed memory of the simulation to the operating system, because the measured memory of a
  // method would be too small if the method could reuse the freed memory.
  malloc_trim(0);
  DrawFiles files(task.keeping);
  bool failed = false;
  Given given;
  for (const DrawTask::Run& run : task.runs) {
    const Outcome outcome = run_one(task, run, *made, timeout_s, given, files);
    failed = failed || (run.setting.is_plain() && outcome.status != OutcomeStatus::ok);
    if (!write_all(fd, to_line({outcome, {}}))) return;
  }
  files.finish(made->draw, failed);
  if (!files.error_code().empty()) write_all(fd, to_line({{}, {}, {}, files.error_code()}));
}

}  // namespace tumble::scenarios
