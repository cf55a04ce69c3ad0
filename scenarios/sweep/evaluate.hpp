// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "sim/built_situation.hpp"

namespace tumble::scenarios {

/// SimulatedDraw is one run, simulated or read from a recording, on which the methods run.
struct SimulatedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;  ///< set for simulations; contains the true surface
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  bool has_truth = true;  ///< a recording without truth is estimated but not scored
};

/// Lidars states whether the lidars are simulated. The simulation of lidars is slow, and methods of kind `rate` do not
/// read them.
enum class Lidars { simulated, left_out };

/// Draws the random numbers of a scenario, builds the situation and simulates it. Without lidars, motion and IMU
/// readings are bit-identical, but the digest of the recording differs. Throws BadInput, sim::InvalidSituation or
/// sim::SimulationFailure if the simulation is impossible.
SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars = Lidars::simulated);

/// Returns the digest that the recording would have without its lidars.
std::string digest_without_lidars(const sim::Recording& recording);

/// Returns the properties of a scenario that determine which methods can run on it.
Subject subject_of(const Scenario& scenario);

/// Returns the methods that can run on `subject`, in the order of `methods`.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject);

/// Throws BadInput, with the reason, if a method cannot run on a scenario.
void require_applies(const Method& method, const Scenario& scenario);

/// Runs a method on the sensor data of `draw` and returns the estimate. The status of `outcome` is failed after an
/// exception or an error status. Without an error, the status is ok, and the estimate can be scored. The CPU time of
/// the method is the first score.
Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome);

/// Sets status and message of the outcome without comparison with the truth. The status is failed after an error,
/// diverged if the health of one of our methods reports a fault that invalidates the estimate, and otherwise ok.
void judge_without_truth(const MethodInfo& info, const Estimate& estimate, Outcome& outcome);

/// Adds status and scores of a completed estimate to the outcome. `surface` may be null.
void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome);

/// Returns the original run `draw` with the IMU time stamps of `given`. Each estimate is then compared with the truth
/// of its IMU sample, even if time stamps were changed.
SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given);

/// Returns the CPU time of this process and of its finished child processes [s].
double process_cpu_s();

}  // namespace tumble::scenarios
