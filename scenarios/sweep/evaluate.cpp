// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/evaluate.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/external/external_method.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/motion_summary.hpp"
#include "scenarios/sweep/variation.hpp"
#include "scenarios/text.hpp"
#include "sim/simulate.hpp"

namespace tumble::scenarios {

SimulatedDraw simulate_draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, int threads,
                            Lidars lidars) {
  SimulatedDraw simulated;
  simulated.scenario = scenario.name;
  simulated.seed = seed;
  const sim::ResolvedSituation situation = draw(data, scenario, seed);
  const double start_s = process_cpu_s();
  simulated.built.emplace(lidars == Lidars::left_out ? without_lidars(situation) : situation, data.models());
  simulated.recording = sim::simulate(*simulated.built, threads);
  simulated.simulate_cpu_s = process_cpu_s() - start_s;
  simulated.recording_digest = digest(simulated.recording.sensors, &simulated.recording.truth);
  return simulated;
}

std::string digest_without_lidars(const sim::Recording& recording) {
  sim::Recording bare = recording;
  bare.sensors.lidars.clear();
  bare.truth.lidars.clear();
  return digest(bare.sensors, &bare.truth);
}

Subject subject_of(const Scenario& scenario) {
  return {scenario.robot.type, has_lidar(scenario)};
}

std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const Subject& subject) {
  std::vector<MethodPointer> chosen;
  std::copy_if(methods.begin(), methods.end(), std::back_inserter(chosen),
               [&](const MethodPointer& method) { return method->info.applies_to(subject); });
  return chosen;
}

void require_applies(const Method& method, const Scenario& scenario) {
  const std::string why = method.info.why_not(subject_of(scenario));
  if (!why.empty())
    throw BadInput(
        fmt::format("method '{}' cannot run on scenario {}: the method {}", method.info.name, scenario.name, why));
}

namespace {

OutcomeStatus status_of(NoAnswer::Why why) {
  switch (why) {
    case NoAnswer::Why::crashed:
      return OutcomeStatus::crashed;
    case NoAnswer::Why::timed_out:
      return OutcomeStatus::timeout;
    case NoAnswer::Why::machine:
      break;
  }
  return OutcomeStatus::killed;
}

Estimate no_estimate(const std::string& transcript = "") {
  Estimate none;
  none.transcript = transcript;
  none.status = {ErrorCode::empty, "estimate", 0.0, 1.0};
  return none;
}

}  // namespace

void judge_without_truth(const MethodInfo& info, const Estimate& estimate, Outcome& outcome) {
  outcome.status = OutcomeStatus::ok;
  outcome.message.clear();
  if (!estimate.status.ok()) {
    outcome.status = OutcomeStatus::failed;
    outcome.message = one_line(estimate.status.message());
    return;
  }
  const std::vector<HealthFinding>& findings = estimate.faults.findings;
  const auto fault =
      std::ranges::find_if(findings, [](const HealthFinding& each) { return each.invalidates_estimate(); });
  if (!info.ours || fault == findings.end()) return;
  outcome.status = OutcomeStatus::diverged;
  outcome.message = one_line("health: " + to_text(*fault));
}

Estimate run_method(const Method& method, const SimulatedDraw& draw, Outcome& outcome) {
  outcome.scenario = draw.scenario;
  outcome.seed = draw.seed;
  outcome.kind = method.info.kind;
  outcome.method = method.info.name;
  outcome.recording_digest = draw.recording_digest;
  outcome.status = OutcomeStatus::ok;

  Estimate estimate;
  const double start_s = process_cpu_s();
  try {
    OracleInput oracle;
    if (method.info.needs_truth) oracle.truth = &draw.recording.truth;
    estimate = method.run(draw.recording.sensors, {}, oracle);
    if (!estimate.status.ok()) judge_without_truth(method.info, estimate, outcome);
  } catch (const NoAnswer& error) {
    estimate = no_estimate(error.transcript());
    outcome.status = status_of(error.why());
    outcome.message = one_line(error.what());
  } catch (const std::bad_alloc&) {
    estimate = no_estimate();
    outcome.status = OutcomeStatus::killed;
    outcome.message =
        "there is not enough memory for the method; free memory or increase the memory limit of a process";
  } catch (const RefusedAnswer& error) {
    estimate = no_estimate(error.transcript());
    outcome.status = OutcomeStatus::failed;
    outcome.message = one_line(error.what());
  } catch (const std::exception& error) {
    estimate = no_estimate();
    outcome.status = OutcomeStatus::failed;
    outcome.message = one_line(error.what());
  }
  outcome.scores.push_back({"estimate_cpu_s", process_cpu_s() - start_s});
  outcome.scores.push_back({"simulate_cpu_s", draw.simulate_cpu_s});
  return estimate;
}

namespace {

void score_estimate(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface,
                    const Estimate& estimate, Outcome& outcome) {
  try {
    const ScoredEstimate scored(estimate, {&draw.recording.sensors, &draw.recording.truth, surface});
    outcome.status = verdict(method.info.kind, scored);
    if (outcome.status == OutcomeStatus::diverged)
      outcome.message = "the estimate diverged from the truth, is outside the recording's time range, or is not finite";
    for (Score& score : score(method.info.kind, scored)) outcome.scores.push_back(std::move(score));
  } catch (const std::bad_alloc&) {
    outcome.status = OutcomeStatus::killed;
    outcome.message =
        "there is not enough memory to score the estimate; free memory or increase the memory limit of a process";
  } catch (const std::exception& error) {
    outcome.status = OutcomeStatus::failed;
    outcome.message = one_line(std::string("scoring failed: ") + error.what());
  }
}

}  // namespace

void assess(const Method& method, const SimulatedDraw& draw, const sim::Surface* surface, const Estimate& estimate,
            Outcome& outcome) {
  outcome.estimate_digest = digest(estimate);
  if (outcome.status != OutcomeStatus::ok) return;
  if (draw.has_truth) score_estimate(method, draw, surface, estimate, outcome);
  if (outcome.status == OutcomeStatus::ok) judge_without_truth(method.info, estimate, outcome);
}

SimulatedDraw scored_by(const SimulatedDraw& draw, const SimulatedDraw& given) {
  SimulatedDraw scored = draw;
  std::vector<sim::ImuRecord>& imus = scored.recording.sensors.imus;
  for (std::size_t i = 0; i < imus.size(); ++i) imus[i].time_ns = given.recording.sensors.imus[i].time_ns;
  return scored;
}

double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  rusage children{};
  getrusage(RUSAGE_CHILDREN, &children);
  return static_cast<double>(now.tv_sec + children.ru_utime.tv_sec + children.ru_stime.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec) +
         1e-6 * static_cast<double>(children.ru_utime.tv_usec + children.ru_stime.tv_usec);
}

RunResult run_situation(const DataRoot& data, const Scenario& scenario, std::uint64_t seed,
                        std::span<const MethodPointer> methods, int threads, Lidars lidars, const Setting& setting) {
  SimulatedDraw draw = simulate_draw(data, with_setting(scenario, setting), seed, threads, lidars);
  std::optional<SimulatedDraw> original;  // for scoring modified sensor data
  if (reach(setting) == Reach::input) {
    SimulatedDraw given = with_setting(draw, setting);
    original = scored_by(draw, given);
    draw = std::move(given);
  }
  RunResult result;
  result.methods = applicable(methods, subject_of(scenario));
  const bool maps = std::any_of(result.methods.begin(), result.methods.end(),
                                [](const MethodPointer& method) { return method->info.kind == Kind::slam; });
  if (maps) result.surface = std::make_shared<const sim::Surface>(*draw.built);
  for (const MethodPointer& method : result.methods) {
    Outcome outcome;
    outcome.setting = setting;
    Estimate estimate = run_method(with_setting(*method, setting), draw, outcome);
    assess(*method, original ? *original : draw, result.surface.get(), estimate, outcome);
    result.estimates.push_back(std::move(estimate));
    result.outcomes.push_back(std::move(outcome));
  }
  result.scenario = std::move(draw.scenario);
  result.seed = draw.seed;
  result.built = std::move(draw.built);
  result.recording = std::move(draw.recording);
  result.recording_digest =
      original ? digest(result.recording.sensors, &result.recording.truth) : std::move(draw.recording_digest);
  result.simulate_cpu_s = draw.simulate_cpu_s;
  return result;
}

std::string run_digest(const RunResult& result) {
  std::vector<std::string> parts = {result.recording_digest};
  for (std::size_t k = 0; k < result.methods.size(); ++k) {
    parts.push_back(full_name(result.methods[k]->info));
    parts.push_back(digest(result.estimates[k]));
  }
  return digest_of_texts(parts);
}

namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::nan("") : static_cast<double>(part) / static_cast<double>(whole);
}

double duration_s(const sim::ImuRecord& imu) {
  return imu.time_ns.empty() ? 0.0 : 1e-9 * static_cast<double>(imu.time_ns.back() - imu.time_ns.front());
}

}  // namespace

DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording) {
  DrawValues draw{scenario, seed, {}};
  if (recording.sensors.imus.empty()) return draw;
  const MotionSummary motion = summarise_motion(recording.sensors, recording.truth);
  draw.values = {{"motion_duration_s", duration_s(recording.sensors.imus.front())},
                 {"motion_moving_s", motion.moving_s},
                 {"motion_path_m", motion.path_m},
                 {"motion_peak_rate_rad_s", motion.peak_rate_rad_s},
                 {"motion_peak_accel_m_s2", motion.peak_accel_m_s2},
                 {"motion_flight_share", motion.flight_share},
                 {"motion_impacts", static_cast<double>(motion.impacts)},
                 {"motion_clips", motion.clipped_samples > 0 ? 1.0 : 0.0},
                 {"motion_clipped_share", share(motion.clipped_samples, motion.samples)},
                 {"motion_clipped_samples", static_cast<double>(motion.clipped_samples)},
                 {"motion_clip_depth_max_rad_s", motion.clip_depth_max_rad_s},
                 {"motion_clip_length_max_s", motion.clip_length_max_s},
                 {"motion_several_axes_share", share(motion.several_axes_samples, motion.clipped_samples)},
                 {"motion_cross_axis_share", share(motion.cross_axis_samples, motion.clipped_samples)},
                 {"motion_accel_clipped_share", share(motion.accel_clipped_samples, motion.samples)}};
  return draw;
}

DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording) {
  DrawValues draw{scenario, seed, {}};
  if (recording.sensors.imus.empty()) return draw;
  double peak_rad_s = 0.0;
  for (const Eigen::Vector3d& w : recording.sensors.imus.front().gyro_rad_s)
    peak_rad_s = std::max(peak_rad_s, w.norm());
  draw.values = {{"motion_duration_s", duration_s(recording.sensors.imus.front())},
                 {"motion_peak_rate_rad_s", peak_rad_s}};
  if (recording.truth.imus.empty() || recording.truth.imus.front().rate_rad_s.empty()) return draw;
  const ClippingTruth clipping(recording.sensors, recording.truth);
  std::size_t clipped = 0;
  double depth_rad_s = 0.0;
  for (std::size_t i = 0; i < clipping.size(); ++i) {
    if (clipping.clipped_axes(i) == 0) continue;
    ++clipped;
    depth_rad_s = std::max(depth_rad_s, clipping.depth_rad_s(i));
  }
  draw.values.push_back({"motion_clips", clipped > 0 ? 1.0 : 0.0});
  draw.values.push_back({"motion_clipped_share", share(clipped, clipping.known_samples())});
  draw.values.push_back({"motion_clipped_samples", static_cast<double>(clipped)});
  draw.values.push_back({"motion_clip_depth_max_rad_s", depth_rad_s});
  return draw;
}

}  // namespace tumble::scenarios
