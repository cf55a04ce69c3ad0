// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/built_situation.hpp"
#include "sim/lidar/surface.hpp"

namespace tumble::scenarios {

/// Everything that one situation gave: recording, and per method its estimate and outcome.
struct RunResult {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;     ///< what it was simulated in
  std::shared_ptr<const sim::Surface> surface;  ///< what its maps were scored against; null when no method makes one
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  std::vector<MethodPointer> methods;
  std::vector<Estimate> estimates;  ///< parallel to methods
  std::vector<Outcome> outcomes;    ///< parallel to methods
};

/// Draws, simulates, estimates and scores one situation in this process. Methods that do not apply to the robot are
/// left out. With a `setting` the run is the point of a curve that a sweep makes of it (variation.hpp), the recording
/// what the methods were given. Throws BadInput, sim::InvalidSituation, sim::SimulationFailure.
RunResult run_situation(const DataRoot& data, const Scenario& scenario, std::uint64_t seed,
                        std::span<const MethodPointer> methods, int threads, Lidars lidars = Lidars::simulated,
                        const Setting& setting = {});

/// Digest of a whole run: recording and every estimate.
std::string run_digest(const RunResult& result);

}  // namespace tumble::scenarios
