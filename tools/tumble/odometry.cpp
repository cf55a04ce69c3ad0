// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "scenarios/diagnosis/diagnosis.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tools/replay/page.hpp"
#include "tools/replay/replay.hpp"
#include "tools/tumble/chosen_method.hpp"
#include "tools/tumble/odometry_options.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;
using scenarios::Estimate;

struct OdometryCommand {
  OdometryOptions odometry;
  std::filesystem::path folder;
};

void require_both_sensors(const std::filesystem::path& path, const sim::Sensors& sensors) {
  if (!sensors.imus.empty() && !sensors.lidars.empty()) return;
  const std::string file = path.string();
  throw BadInput(fmt::format(
      "{}: odometry needs an IMU and a lidar; the recording has no {}. {}", file,
      sensors.imus.empty() ? "IMU" : "lidar",
      sensors.lidars.empty()
          ? fmt::format(
                "For an IMU alone: 'tumble import {} -o r.h5', then 'tumble estimate r.h5 --method rate/tumble'", file)
          : "Add IMU readings with --imu FILE.csv"));
}

/// Only the ends of the sweeps count for the path length, because the poses between would add noise. The step from the
/// local frame to the frame of a prior map is no motion.
double path_length_m(const Estimate& estimate) {
  double sum_m = 0.0;
  for (std::size_t k = 1; k < estimate.sweeps.size(); ++k) {
    const SweepResult& last = estimate.sweeps[k - 1];
    const SweepResult& sweep = estimate.sweeps[k];
    if (sweep.in_prior_map == last.in_prior_map) sum_m += (sweep.pose.position_W_m - last.pose.position_W_m).norm();
  }
  return sum_m;
}

double imu_duration_s(const sim::ImuRecord& imu) {
  return imu.time_ns.empty() ? 0.0 : 1e-9 * static_cast<double>(imu.time_ns.back() - imu.time_ns.front());
}

std::string health_text(const Estimate& estimate, scenarios::OutcomeStatus status) {
  if (status == scenarios::OutcomeStatus::failed) return "failed";
  std::string text;
  for (const HealthFinding& finding : estimate.faults.findings)
    if (scenarios::is_current(finding)) text += (text.empty() ? "" : ", ") + std::string(to_string(finding.kind));
  if (status == scenarios::OutcomeStatus::diverged) return "diverged: " + text;
  return text.empty() ? "ok" : text;
}

nlohmann::json summary_of(const sim::Sensors& sensors, const Estimate& estimate, scenarios::OutcomeStatus status,
                          double run_s) {
  const std::size_t sweeps = sensors.lidars.front().sweep_start_ns.size();
  const scenarios::Saturation saturation = scenarios::saturation_of(sensors.imus.front());
  const auto count = [&](SweepVerdict verdict) {
    return std::ranges::count_if(estimate.sweeps, [&](const auto& sweep) { return sweep.verdict == verdict; });
  };
  const auto registered = static_cast<long>(estimate.sweeps.size()) - count(SweepVerdict::rejected);
  return {{"duration_s", imu_duration_s(sensors.imus.front())},
          {"path_m", path_length_m(estimate)},
          {"sweeps_registered", registered},
          {"sweeps_degenerate", count(SweepVerdict::degenerate)},
          {"sweeps", sweeps},
          {"clipped_share", saturation.gyro_share},
          {"health", health_text(estimate, status)},
          {"sweeps_per_s", run_s > 0.0 ? static_cast<double>(sweeps) / run_s : 0.0}};
}

Table summary_table(const nlohmann::json& summary) {
  Table table("result", {"duration", "path", "sweeps registered", "samples clipped", "health", "speed"});
  table.add_row({fmt::format("{:.1f} s", summary["duration_s"].get<double>()),
                 fmt::format("{:.1f} m", summary["path_m"].get<double>()),
                 fmt::format("{} of {} ({} degenerate)", summary["sweeps_registered"].get<long>(),
                             summary["sweeps"].get<std::size_t>(), summary["sweeps_degenerate"].get<long>()),
                 fmt::format("{:.1f} %", 100.0 * summary["clipped_share"].get<double>()),
                 summary["health"].get<std::string>(),
                 fmt::format("{:.0f} sweeps/s", summary["sweeps_per_s"].get<double>())});
  return table;
}

void write_replay(const std::filesystem::path& page, const OpenRecording& recording, const std::string& method,
                  const Estimate& estimate) {
  ReplayInput input;
  input.title = recording.options.path.filename().string();
  if (!recording.content.info.attribution.empty())
    input.facts.emplace_back("recorded by", recording.content.info.attribution);
  input.sensors = &recording.content.sensors;
  input.truth = recording.truth ? &*recording.truth : nullptr;
  input.estimates.push_back({method, &estimate});
  scenarios::replace_file(page, replay_page(replay_of(input, {})));
}

void print_notes(const Session& session, const OpenRecording& recording, const std::string& method,
                 const Estimate& estimate) {
  if (std::ranges::any_of(estimate.sweeps, [](const auto& sweep) { return sweep.verdict == SweepVerdict::degenerate; }))
    session.note(
        "in a degenerate sweep, the lidar determines the pose in some directions only. In the other directions, the "
        "IMU predicts the pose, and the covariance is larger");
  if (estimate.replaced_T_BL)
    session.note(
        fmt::format("the program used an estimated pose of the lidar, because the stated pose or the clock of the "
                    "lidar contradicts the recording: {}",
                    scenarios::lidar_pose_option(*estimate.replaced_T_BL)));
  for (const Repair& repair : recording.repairs)
    session.note(
        fmt::format("the program set the option {} {}: {}", repair.option.name, repair.option.value, repair.cause));
  for (const scenarios::RecordingFinding& each : scenarios::findings_in_notes(recording.content.notes))
    session.note(each.where + ": " + each.evidence);
  const std::size_t sweeps = recording.content.sensors.lidars.front().sweep_start_ns.size();
  for (const scenarios::RecordingFinding& each : scenarios::findings_in_estimate(estimate, method, sweeps))
    session.note(each.evidence + (each.repair.empty() ? "" : ". Repair: " + each.repair));
}

int run_odometry(const Session& session, const OdometryCommand& command) {
  const OdometryOptions& options = command.odometry;
  check_odometry_options(options);
  scenarios::OutputFolder folder(command.folder);
  OpenRecording recording = open_recording(session, options.input);
  const sim::Sensors& sensors = recording.content.sensors;
  require_both_sensors(options.input.path, sensors);
  OdometrySetup setup = set_up_odometry(session, options, recording);
  if (!session.json) session.print({found_table(setup.found)}, {});
  const scenarios::MethodInfo& info = setup.method.info;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Estimate estimate = run_method(session, setup.method, sensors);
  const double run_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (estimate.replaced_T_BL) set_replaced_pose(*estimate.replaced_T_BL, setup.found);
  estimate.settings = setup.found;
  estimate.T_base_imu = recording.content.T_base_imu;
  scenarios::write_estimate(command.folder, info.name, info.kind, estimate, recording.digest,
                            recording.content.info.origin_ns);
  if (!estimate.map.empty()) {
    scenarios::write_map_pcd(command.folder / "map.pcd", estimate.map);
    scenarios::write_prior_map(command.folder / scenarios::kPriorMapName, estimate.map);
  }
  if (!estimate.poses.empty()) write_replay(command.folder / "replay.html", recording, full_name(info), estimate);
  folder.keep();

  print_notes(session, recording, full_name(info), estimate);
  if (!options.prior_map.map.empty()) session.note(localisation_text(options.prior_map, estimate));
  scenarios::Outcome outcome;
  judge_without_truth(info, estimate, outcome);
  const nlohmann::json summary = summary_of(sensors, estimate, outcome.status, run_s);
  session.print({summary_table(summary)}, {{"folder", command.folder.string()},
                                           {"method", full_name(info)},
                                           {"status", to_string(outcome.status)},
                                           {"message", outcome.message.empty() ? "ok" : outcome.message},
                                           {"found", found_document(setup.found)},
                                           {"summary", summary},
                                           {"health", estimate.health}});
  if (estimate.status.ok()) {
    session.note(
        fmt::format("written: {} (trajectory.tum, map.ply, map.pcd, map.tumblemap, estimate.json, replay.html, and "
                    "tables of rates, sweeps and covariances)",
                    command.folder.string()));
    if (outcome.status != scenarios::OutcomeStatus::diverged) return kDone;
    session.note(
        fmt::format("do not use this estimate; 'tumble doctor {}' with the same sensor options searches for the cause",
                    options.input.path.string()));
    return kCheckFailed;
  }
  throw BadInput(
      fmt::format("{}: {} failed: {}; 'tumble doctor {}' with the same sensor options searches for the cause",
                  options.input.path.string(), full_name(info), failure_reason(estimate.status, sensors),
                  options.input.path.string()));
}

}  // namespace

Action declare_odometry(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<OdometryCommand>();
  declare_odometry_options(verb, options->odometry);
  verb.add("-o,--output", options->folder, "writes trajectory, map, health and replay page to this folder").required();
  verb.footer(
      "Exit status: 0 estimate written, 1 estimate written but its health is 'diverged', 2 wrong use or bad input.");
  return [&session, options] { return run_odometry(session, *options); };
}

}  // namespace tumble::tools
