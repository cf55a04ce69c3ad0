// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/recorded_draw.hpp"

namespace tumble::scenarios {

struct DrawTask {
  std::string name;                         ///< name of the scenario or recording
  const Scenario* scenario = nullptr;       ///< scenario of a simulation, else null
  const RecordedDraw* recording = nullptr;  ///< recording that is read, else null
  std::uint64_t seed = 0;
  Setting setting;  ///< setting of the simulation
  struct Run {
    const Method* method;
    Setting setting;  ///< of the simulation and the methods
  };
  std::vector<Run> runs;
  Keeping keeping;  ///< only for unmodified scenarios
};

/// Time limit of a simulation, as a multiple of the time limit of one method.
inline constexpr double kSimulateTimeouts = 2.0;

OutcomeStatus ended_as(const Process::End& end);

std::vector<Outcome> without_answer(const DrawTask& task, OutcomeStatus status, const std::string& message);

/// Simulates or reads a run and runs its methods. Writes one message per line to `fd`: the outcome of a method, or an
/// error if the run cannot be simulated or read.
void run_draw(const DataRoot& data, const DrawTask& task, double timeout_s, int fd, bool recordings_unseen = false);

/// Runs one method in a separate process for at most `timeout_s` of wall time. A crash, a time-out or an exception of
/// the method becomes an outcome with a corresponding status. `scored` contains the truth for the scores, and equals
/// `draw` unless the sensor data were changed.
Outcome run_isolated(const Method& method, const SimulatedDraw& draw, const SimulatedDraw& scored,
                     const sim::Surface* surface, double timeout_s, const std::filesystem::path& folder = {},
                     std::string* not_kept = nullptr);

}  // namespace tumble::scenarios
