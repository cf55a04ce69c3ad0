// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/sweep/run_again.hpp"

namespace tumble::scenarios {

namespace {

// Time limit of an external command, as a fraction of the method's time limit. With the smaller limit, the process that
// starts the external command can end the command before the process itself reaches the time limit.
constexpr double kOwnShare = 0.9;

}  // namespace

SweepPlan::SweepPlan(const DataRoot& data, const Suite& suite, const SweepOptions& options,
                     const std::filesystem::path& database)
    : suite_(suite),
      options_(options),
      kept_(database),
      methods_(find_methods_within(suite.methods, kOwnShare * suite.timeout_s)) {
  for (const Variation& curve : suite.curves) {
    for (const Setting& setting : curve.settings())
      (reach(setting) == Reach::simulation ? simulated_ : shared_).push_back(setting);
  }
  for (const std::string& name : suite.scenarios) {
    Planned planned{name, load_scenario(data, name), {}};
    planned.methods = applicable(methods_, subject_of(planned.scenario));
    if (options.selects)
      std::erase_if(planned.methods, [&](const auto& method) { return !options.selects(name, method->info); });
    scenarios_.push_back(std::move(planned));
  }
  if (!suite.recordings.empty()) {
    for (RecordedDraw& recording : find_recordings(suite.recordings, suite.recordings_folder)) {
      std::vector<MethodPointer> own = applicable(methods_, recording);
      recordings_.push_back({std::move(recording), std::move(own)});
    }
  }
  const auto idle = [](const auto& each) { return each.methods.empty(); };
  if (std::all_of(scenarios_.begin(), scenarios_.end(), idle) &&
      std::all_of(recordings_.begin(), recordings_.end(), idle)) {
    throw BadInput(fmt::format(
        "suite {}: no method of the suite supports the robots and sensors of the suite's runs; add such a method",
        suite.name));
  }
  for (const Planned& each : scenarios_) draw(data, each.scenario, suite.first_seed);
  next_.seed = suite.first_seed;
  next_.past_seeds = scenarios_.empty();
  if (!at_end() && !is_wanted()) advance();
}

std::uint64_t SweepPlan::draws_total() const {
  return recordings_.size() + suite_.draw_count() * simulated_.size();
}

void SweepPlan::require_same_recordings(const Results& results) const {
  for (const Recorded& each : recordings_) {
    for (const Outcome& row : results.outcomes_of(each.recording.name, kRecordingSeed)) {
      if (row.recording_digest.empty() || row.recording_digest == each.recording.digest) continue;
      throw BadInput(
          fmt::format("{}: the recording has the digest {}, but the results in the database belong to a recording with "
                      "the digest {}; choose another database",
                      each.recording.path.string(), each.recording.digest, row.recording_digest));
    }
  }
}

void SweepPlan::note_recordings(Results& results) const {
  for (const Recorded& each : recordings_) {
    results.set_note(recording_note(each.recording.name),
                     std::filesystem::absolute(each.recording.path).lexically_normal().string());
  }
}

bool SweepPlan::is_wanted() const {
  return next_.recording < recordings_.size() || suite_.has_draw(scenarios_[next_.scenario].scenario.name, next_.seed);
}

void SweepPlan::advance() {
  do {
    step();
  } while (!at_end() && !is_wanted());
}

void SweepPlan::step() {
  if (next_.recording < recordings_.size()) {
    ++next_.recording;
    return;
  }
  if (++next_.setting < simulated_.size()) return;
  next_.setting = 0;
  if (++next_.scenario < scenarios_.size()) return;
  next_.scenario = 0;
  next_.past_seeds = next_.seed == suite_.last_seed;
  ++next_.seed;
}

DrawTask SweepPlan::next(const Results& results) const {
  return next_.recording < recordings_.size() ? of_recording(results) : of_scenario(results);
}

void SweepPlan::add_missing(const std::vector<MethodPointer>& methods, const std::vector<Outcome>& held,
                            const Setting& setting, DrawTask& task) const {
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

DrawTask SweepPlan::of_recording(const Results& results) const {
  const Recorded& recorded = recordings_[next_.recording];
  DrawTask task{recorded.recording.name, nullptr, &recorded.recording, kRecordingSeed, {}, {}, {}};
  add_missing(recorded.methods, results.outcomes_of(task.name, task.seed), {}, task);
  return task;
}

DrawTask SweepPlan::of_scenario(const Results& results) const {
  const Planned& planned = scenarios_[next_.scenario];
  const Setting& simulated = simulated_[next_.setting];
  DrawTask task{planned.scenario.name, &planned.scenario, nullptr, next_.seed, simulated, {}, {}};
  for (const RejectedDraw& rejected : results.rejected_of(task.name, task.seed)) {
    if (rejected.setting == simulated) return task;
  }
  const std::vector<Outcome> held = results.outcomes_of(task.name, task.seed);
  add_missing(planned.methods, held, simulated, task);
  if (!simulated.is_plain()) return task;
  for (const Setting& setting : shared_) add_missing(planned.methods, held, setting, task);
  const Keep::Which which = options_.keep.which;
  if (which == Keep::Which::all) task.keeping = keeping(planned, task, Keeping::When::always);
  if (which == Keep::Which::failed) task.keeping = keeping(planned, task, Keeping::When::if_failed);
  task.keeping.lidars = read_lidars(planned, held);
  return task;
}

bool SweepPlan::has(const DrawName& draw) const {
  return suite_.has_draw(draw.scenario, draw.seed) &&
         std::any_of(scenarios_.begin(), scenarios_.end(),
                     [&](const Planned& planned) { return planned.scenario.name == draw.scenario; });
}

DrawTask SweepPlan::again(const DrawName& draw, const Results& results) const {
  DrawTask task{draw.scenario, nullptr, nullptr, draw.seed, {}, {}, {}};
  for (const Planned& planned : scenarios_) {
    if (planned.scenario.name != draw.scenario) continue;
    task.scenario = &planned.scenario;
    const std::vector<Outcome> held = results.outcomes_of(draw.scenario, draw.seed);
    for (const Outcome& row : held) {
      if (!row.setting.is_plain() || !was_scored(row.status)) continue;
      for (const MethodPointer& method : planned.methods) {
        if (method->info.kind == row.kind && method->info.name == row.method) task.runs.push_back({method.get(), {}});
      }
    }
    task.keeping = keeping(planned, task, Keeping::When::always);
    task.keeping.lidars = read_lidars(planned, held);
  }
  return task;
}

bool SweepPlan::read_lidars(const Planned& planned, const std::vector<Outcome>& held) const {
  const auto reads = [](Kind kind) { return kind != Kind::rate; };
  return std::any_of(planned.methods.begin(), planned.methods.end(),
                     [&](const MethodPointer& method) { return reads(method->info.kind); }) ||
         std::any_of(held.begin(), held.end(), [&](const Outcome& row) { return reads(row.kind); }) ||
         std::any_of(shared_.begin(), shared_.end(), [](const Setting& setting) { return needs_lidar(setting); });
}

Keeping SweepPlan::keeping(const Planned& planned, const DrawTask& task, Keeping::When when) const {
  Keeping out{when, kept_.folder_of({task.name, task.seed}), {}, options_.versions};
  out.command = "tumble run " + shell_word(planned.asked) + " --seed " + std::to_string(task.seed);
  for (const std::string& method : suite_.methods) out.command += " --method " + shell_word(method);
  out.command += " -o " + shell_word(task.name + "_" + std::to_string(task.seed));
  return out;
}

}  // namespace tumble::scenarios
