// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "sim/built_situation.hpp"

namespace tumble::scenarios {

struct SimulatedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;  ///< for simulations: true surface
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  bool has_truth = true;  ///< false: estimated, not scored
};

/// The simulation of lidars is slow, and methods of kind `rate` do not read lidars.
enum class Lidars { simulated, left_out };

/// Without lidars, motion and IMU readings are bit-identical, but the digest of the recording differs.
SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars = Lidars::simulated);

std::string digest_without_lidars(const sim::Recording& recording);

Subject subject_of(const Scenario& scenario);

std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject);

void require_applies(const Method& method, const Scenario& scenario);

Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome);

/// Without the truth, the estimate of a built-in method counts as diverged if its health reports a fault that
/// invalidates the estimate.
void judge_without_truth(const MethodInfo& info, const Estimate& estimate, Outcome& outcome);

void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome);

/// Returns the simulated run `draw` with the IMU time stamps of `given`, so that each estimate is compared with the
/// truth of its IMU sample.
SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given);

double process_cpu_s();

}  // namespace tumble::scenarios
