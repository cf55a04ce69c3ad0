// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/recorded_draw.hpp"

namespace tumble::scenarios {

/// One simulation, or one recording, and what is run on it.
struct DrawTask {
  std::string name;                         ///< of the scenario, or of the recording
  const Scenario* scenario = nullptr;       ///< to be simulated; or
  const RecordedDraw* recording = nullptr;  ///< to be read
  std::uint64_t seed = 0;
  Setting setting;  ///< that the simulation is made with
  struct Run {
    const Method* method;
    Setting setting;  ///< the simulation's, or one that leaves the simulation alone
  };
  std::vector<Run> runs;
  Keeping keeping;  ///< of a plain setting alone
};

/// How long one waits for workers at a time before looking at the clock.
inline constexpr int kPollMs = 200;
/// What the simulation of a draw may take beyond its runs, in units of a run's time-out.
inline constexpr double kSimulateTimeouts = 2.0;

/// Of a run whose process ended without an answer.
OutcomeStatus ended_as(const Process::End& end);

/// A row per run of a draw whose process gave no answer.
std::vector<Outcome> without_answer(const DrawTask& task, OutcomeStatus status, const std::string& message);

/// Simulates one draw, without lidars where no method reads them, and tells `fd` what came of it, one message a line: a
/// rejection when it cannot be drawn or simulated, or an outcome per run as each ends. The last word, an empty message,
/// is its caller's. `recordings_unseen` as in SweepOptions. Runs in a worker.
void run_draw(const DataRoot& data, const DrawTask& task, double timeout_s, int fd, bool recordings_unseen = false);

/// Runs one method in a process of its own for at most `timeout_s` of wall time. A crash, a time-out or an exception is
/// an outcome. Cost: CPU and peak memory of the estimate alone, memory above what the draw's process held. The estimate
/// is scored against the sensors and the truth of `scored`, which is `draw` unless its sensors have been changed
/// (triage). It is left in `folder` (estimate_file.hpp) unless that is empty; one that cannot be written is not there,
/// and `not_kept` says why.
Outcome run_isolated(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                     const sim::Surface* surface, double timeout_s, const std::filesystem::path& folder = {},
                     std::string* not_kept = nullptr);

}  // namespace tumble::scenarios
