// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/recorded_draw.hpp"

namespace tumble::scenarios {

/// DrawTask is one run, simulated or recorded, with the methods that process it.
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

/// A process waits at most kPollMs for messages from workers before it checks deadlines.
inline constexpr int kPollMs = 200;
/// The time limit of a simulation is kSimulateTimeouts times the time limit of one method.
inline constexpr double kSimulateTimeouts = 2.0;

/// Returns the status of a method whose process ended without a result.
OutcomeStatus ended_as(const Process::End& end);

/// Returns one outcome with `status` per method, for a run whose process gave no result.
std::vector<Outcome> without_answer(const DrawTask& task, OutcomeStatus status, const std::string& message);

/// Simulates one scenario with one seed, without lidars if no method reads them, and runs the methods of the task. The
/// results are written to `fd`, one message per line. A message is the outcome of a method, or a rejection if the
/// simulation is impossible. The caller writes the final empty message. The flag `recordings_unseen` has the meaning of
/// SweepOptions::recordings_unseen. The function runs in a worker process.
void run_draw(const DataRoot& data, const DrawTask& task, double timeout_s, int fd, bool recordings_unseen = false);

/// Runs one method in a separate process for at most `timeout_s` of wall time. A crash, a time-out or an exception
/// becomes an outcome. The cost in the outcome is the CPU time and peak memory of the method, without the memory of the
/// calling process.
///
/// The estimate is compared with the truth in `scored`, which equals `draw` unless the sensor data were changed
/// (triage). If `folder` is not empty, the estimate is written to `folder` (estimate_file.hpp). If writing fails, the
/// text `not_kept` contains the reason.
Outcome run_isolated(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                     const sim::Surface* surface, double timeout_s, const std::filesystem::path& folder = {},
                     std::string* not_kept = nullptr);

}  // namespace tumble::scenarios
