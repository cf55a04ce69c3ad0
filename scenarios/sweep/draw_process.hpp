// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/recorded_draw.hpp"

namespace tumble::scenarios {

/// One simulation or recording, and the methods to run on it.
struct DrawTask {
  std::string name;                         ///< name of the scenario or recording
  const Scenario* scenario = nullptr;       ///< set for a simulation
  const RecordedDraw* recording = nullptr;  ///< set for a recording
  std::uint64_t seed = 0;
  Setting setting;  ///< setting of the simulation
  struct Run {
    const Method* method;
    Setting setting;  ///< the simulation's setting, or one that does not affect the simulation
  };
  std::vector<Run> runs;
  Keeping keeping;  ///< only for plain settings
};

/// Longest wait for workers before checking deadlines.
inline constexpr int kPollMs = 200;
/// Time limit of a draw's simulation, in multiples of a run's time-out.
inline constexpr double kSimulateTimeouts = 2.0;

/// Returns the status of a run whose process ended without an answer.
OutcomeStatus ended_as(const Process::End& end);

/// Returns one outcome per run of a draw whose process gave no answer.
std::vector<Outcome> without_answer(const DrawTask& task, OutcomeStatus status, const std::string& message);

/// Simulates one draw, without lidars if no method reads them, and writes the results to `fd`, one message per line: a
/// rejection if the draw cannot be drawn or simulated, else an outcome as each run ends. The caller writes the final
/// empty message. `recordings_unseen` as in SweepOptions. Runs in a worker.
void run_draw(const DataRoot& data, const DrawTask& task, double timeout_s, int fd, bool recordings_unseen = false);

/// Runs one method in a separate process for at most `timeout_s` of wall time. Crashes, time-outs and exceptions become
/// outcomes. Cost: CPU time and peak memory of the estimate, excluding the memory of the draw's process.
///
/// The estimate is scored against `scored`, which equals `draw` unless its sensors were changed (triage). It is written
/// to `folder` (estimate_file.hpp) unless that is empty; on failure `not_kept` states why.
Outcome run_isolated(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                     const sim::Surface* surface, double timeout_s, const std::filesystem::path& folder = {},
                     std::string* not_kept = nullptr);

}  // namespace tumble::scenarios
