// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "sim/built_situation.hpp"

namespace tumble::scenarios {

/// One simulated (or recorded) draw, ready for methods: what every outcome of it shares.
struct SimulatedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation>
      built;  ///< of a simulated one: what its recording, its true surface and its pictures are made from
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  bool has_truth = true;  ///< a recording may come without: it is estimated and not scored
};

/// Whether the lidars of a draw are simulated: they cost a good part of the time, and methods of kind `rate` read none.
enum class Lidars { simulated, left_out };

/// Draws, builds and simulates, each once. Motion and IMUs are the same to the bit without lidars, the digest is
/// another. Throws BadInput, sim::InvalidSituation, sim::SimulationFailure.
SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars = Lidars::simulated);

/// Digest of the recording as it is without its lidars.
std::string digest_without_lidars(const sim::Recording& recording);

/// What a scenario's draws are for a method.
Subject subject_of(const Scenario& scenario);

/// The methods that apply to it, in the order given.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject);

/// Throws BadInput that says why a method does not apply to a scenario, where it does not.
void require_applies(const Method& method, const Scenario& scenario);

/// Runs a method on the draw. What it throws or reports as trouble makes `outcome` failed; otherwise `outcome` is left
/// ok, to be scored. CPU time of the estimate is its first score.
Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome);

/// Adds verdict and scores of an estimate that went through. `surface` may be null.
void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome);

/// The draw as it was, but with the stamps of `given`'s IMUs: an estimate is held to the truth of the sample whose
/// stamp it bears, also where the sensors that a method was given have been changed.
SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given);

/// CPU time that this process and the children that it has waited for have used [s].
double process_cpu_s();

}  // namespace tumble::scenarios
