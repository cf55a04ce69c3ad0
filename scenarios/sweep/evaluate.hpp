// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "sim/built_situation.hpp"

namespace tumble::scenarios {

/// SimulatedDraw is one simulated run or recording. All outcomes of the run share this struct.
struct SimulatedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;  ///< set for simulations; contains the true surface
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  bool has_truth = true;  ///< recordings without truth are estimated but not scored
};

/// Lidars states whether the lidars are simulated. The simulation of lidars is slow, and methods of kind `rate` do not
/// read lidars.
enum class Lidars { simulated, left_out };

/// Draws the random numbers, builds the situation and simulates it, each once. Without lidars, motion and IMUs are
/// bit-identical, but the digest differs. Throws BadInput, sim::InvalidSituation or sim::SimulationFailure.
SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars = Lidars::simulated);

/// Returns the digest that the recording would have without its lidars.
std::string digest_without_lidars(const sim::Recording& recording);

/// Returns the properties of a scenario that determine which methods can run on it.
Subject subject_of(const Scenario& scenario);

/// Returns the methods that can run on `subject`, in the order of `methods`.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject);

/// Throws BadInput with the reason if a method does not apply to a scenario.
void require_applies(const Method& method, const Scenario& scenario);

/// Runs a method on the sensor data of `draw`. An exception or error status sets `outcome` to failed. Without an error,
/// `outcome` stays ok and can be scored. The first score of a method is the estimate's CPU time.
Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome);

/// Adds verdict and scores of a completed estimate. `surface` may be null.
void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome);

/// Returns the original simulated run with the IMU stamps of `given`. An estimate is compared with the truth of the IMU
/// sample that has the estimate's stamp, even if the sensor data were modified.
SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given);

/// Returns the CPU time of this process and its finished children [s].
double process_cpu_s();

}  // namespace tumble::scenarios
