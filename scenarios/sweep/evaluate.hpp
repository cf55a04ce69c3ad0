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
#include "scenarios/sweep/outcome.hpp"
#include "sim/built_situation.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"

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

/// Lidars can be left out of a simulation, because their simulation is slow, and methods of kind `rate` do not use
/// lidar data.
enum class Lidars { simulated, left_out };

/// Simulates a run. With or without lidars, motion and IMU readings are bit-identical, but the digest (hash) of the
/// recording differs.
SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars = Lidars::simulated);

std::string digest_without_lidars(const sim::Recording& recording);

Subject subject_of(const Scenario& scenario);

std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject);

void require_applies(const Method& method, const Scenario& scenario);

Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome);

/// Sets the status of an outcome for a recording without truth. The estimate of a built-in method counts as diverged if
/// its health findings contain a fault that invalidates the estimate.
void judge_without_truth(const MethodInfo& info, const Estimate& estimate, Outcome& outcome);

void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome);

/// Returns a copy of the simulated run `draw` with the IMU time stamps of `given`, which is the same run with added
/// sensor errors. With the time stamps of `given`, the scores compare each estimate with the truth of the corresponding
/// IMU sample.
SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given);

double process_cpu_s();

struct RunResult {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;     ///< the simulated situation
  std::shared_ptr<const sim::Surface> surface;  ///< null without maps
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  std::vector<MethodPointer> methods;
  std::vector<Estimate> estimates;  ///< parallel to methods
  std::vector<Outcome> outcomes;    ///< parallel to methods
};

/// Simulates a scenario and runs the methods. `setting` changes one parameter of the scenario or of the sensor data.
/// The returned recording contains the sensor data that the methods receive.
RunResult run_situation(const DataRoot& data, const Scenario& scenario, std::uint64_t seed,
                        std::span<const MethodPointer> methods, int threads, Lidars lidars = Lidars::simulated,
                        const Setting& setting = {});

std::string run_digest(const RunResult& result);

/// Computes statistics of a simulated motion (scenarios/scoring/motion_summary.hpp) as named numbers for the results
/// database.
///
/// - `motion_moving_s`: time between first and last movement; `motion_path_m`: path length of the centre of mass
/// - `motion_peak_rate_rad_s`: largest rate; `motion_peak_accel_m_s2`: largest specific force before saturation
/// - `motion_clip_depth_max_rad_s`: largest saturation deficit; `motion_clip_length_max_s`: longest clipping interval
/// - `motion_several_axes_share`: fraction of the clipped samples with at least two clipped axes
/// - `motion_cross_axis_share`: fraction of the clipped samples in which clipping also disturbs an unclipped axis
DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

/// Computes statistics of a recorded motion. The clipping values `motion_clips`, `motion_clipped_share`,
/// `motion_clipped_samples` and `motion_clip_depth_max_rad_s` need reference rates.
DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

}  // namespace tumble::scenarios
