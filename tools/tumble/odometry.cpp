// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "scenarios/diagnosis/diagnosis.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tools/replay/page.hpp"
#include "tools/replay/replay.hpp"
#include "tools/tumble/chosen_method.hpp"
#include "tools/tumble/found.hpp"
#include "tools/tumble/prior_map_options.hpp"
#include "tools/tumble/progress.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;
using scenarios::Estimate;

struct OdometryOptions {
  ImportOptions input;
  std::filesystem::path folder;
  std::string method;
  bool live = false;
  PriorMapOptions prior_map;
  std::vector<double> own_body_m;
  std::vector<std::string> parameters;
};

Eigen::AlignedBox3d own_body(const OdometryOptions& options) {
  if (options.own_body_m.empty()) return scenarios::presets::rig_body_L();
  const Eigen::Vector3d min = Eigen::Vector3d::Map(options.own_body_m.data()),
                        max = Eigen::Vector3d::Map(options.own_body_m.data() + 3);
  if (!((min.array() <= max.array()).all()))
    throw BadInput("--own-body: the first corner must not exceed the second corner in any coordinate");
  return {min, max};
}

std::string method_name(const OdometryOptions& options) {
  if (options.live && !options.method.empty())
    throw BadInput("--live and --method exclude each other; --live means --method slam/tumble_live");
  if (!options.method.empty()) return options.method;
  if (options.live) return "slam/tumble_live";
  return options.prior_map.map.empty() ? "slam/tumble" : "slam/tumble_lag";
}

bool has_parameter(const scenarios::MethodInfo& info, std::string_view name) {
  return std::ranges::count(info.parameters, name, &sim::Parameter::name) > 0;
}

std::vector<std::string> parameter_texts(const OdometryOptions& options, const scenarios::MethodInfo& info,
                                         bool states_lidar_pose) {
  std::vector<std::string> texts = options.parameters;
  const auto assume = [&](const std::string& name, double value) {
    const std::string parameter = full_name(info) + "." + name + "=";
    const bool given = std::ranges::any_of(texts, [&](const std::string& text) { return text.starts_with(parameter); });
    if (!given && has_parameter(info, name)) texts.push_back(fmt::format("{}{}", parameter, value));
  };
  if (!states_lidar_pose) {
    assume("mount_sigma_m", kAssumedLidarSigma_m);
    assume("mount_sigma_rad", kAssumedLidarSigma_rad);
  }
  if (options.own_body_m.empty()) return texts;
  const char* const names[] = {"own_body_min_x_m", "own_body_min_y_m", "own_body_min_z_m",
                               "own_body_max_x_m", "own_body_max_y_m", "own_body_max_z_m"};
  const bool in_mapper = has_parameter(info, "mapping_own_body_min_x_m");
  for (std::size_t k = 0; k < std::size(names); ++k)
    texts.push_back(
        fmt::format("{}.{}{}={}", full_name(info), in_mapper ? "mapping_" : "", names[k], options.own_body_m[k]));
  return texts;
}

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

double run_with_progress(const Session& session, const scenarios::Method& method, const sim::Sensors& sensors,
                         Estimate& estimate) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  ProgressDisplay display = ProgressDisplay::on_standard_error();
  const Clock::time_point start = Clock::now();
  Clock::time_point pass = start;
  RegistrationProgress progress;
  std::function<void(std::size_t, std::size_t)> on_sweep;
  if (!session.quiet && display.is_on_terminal())
    on_sweep = [&](std::size_t done, std::size_t all) {
      if (done <= progress.done) pass = Clock::now();
      progress = {done, all, since(pass)};
      display.show(progress);
    };
  estimate = run_method(method, sensors, on_sweep);
  if (progress.all > 0) display.finish(progress);
  return since(start);
}

/// Only the ends of the sweeps count for the path length, because the poses between would add noise. The step from the
/// local frame to the frame of a prior map is no motion.
double path_length_m(const Estimate& estimate) {
  double sum_m = 0.0;
  for (std::size_t k = 1; k < estimate.sweeps.size(); ++k) {
    const SweepReport& last = estimate.sweeps[k - 1];
    const SweepReport& sweep = estimate.sweeps[k];
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

void print_notes(const Session& session, const OpenRecording& recording, const Estimate& estimate) {
  if (std::ranges::any_of(estimate.sweeps, [](const auto& sweep) { return sweep.verdict == SweepVerdict::degenerate; }))
    session.note(
        "in a degenerate sweep, the lidar determines the pose in some directions only; in the other directions, the "
        "pose is predicted from the IMU and its covariance is larger");
  if (estimate.replaced_T_BL)
    session.note(
        fmt::format("the stated pose or clock of the lidar contradicts the recording, so the program used its estimate "
                    "of the pose: {}",
                    pose_text(*estimate.replaced_T_BL)));
  for (const Repair& repair : recording.repairs)
    session.note(
        fmt::format("the program set the option {} {}: {}", repair.option.name, repair.option.value, repair.cause));
  for (const scenarios::RecordingFinding& each : scenarios::findings_in_notes(recording.content.notes))
    session.note(each.where + ": " + each.evidence);
  for (const HealthFinding& each : estimate.faults.findings) session.note(scenarios::report_text(each));
}

int run_odometry(const Session& session, const OdometryOptions& options) {
  const Eigen::AlignedBox3d box = own_body(options);
  const std::string name = method_name(options);
  scenarios::OutputFolder folder(options.folder);
  OpenRecording recording = open_recording(session, options.input);
  const sim::Sensors& sensors = recording.content.sensors;
  require_both_sensors(options.input.path, sensors);
  const scenarios::Method method = with_prior_map(*chosen_method(name, {sensors.robot, true}), options.prior_map);
  const std::vector<FoundItem> found = complete_recording(session, recording, box, !options.own_body_m.empty());
  if (!session.json) session.print({found_table(found)}, {});
  const scenarios::MethodInfo& info = method.info;
  const scenarios::MethodPointer chosen[] = {scenarios::unowned(method)};
  const std::vector<scenarios::Method> methods =
      scenarios::with_parameters(chosen, parameter_texts(options, info, states_lidar_pose(found)));
  Estimate estimate;
  const double run_s = run_with_progress(session, methods.front(), sensors, estimate);
  scenarios::write_estimate(options.folder, info.name, info.kind, estimate, scenarios::digest(sensors, nullptr),
                            recording.content.info.origin_ns);
  if (!estimate.map.empty()) {
    scenarios::write_map_pcd(options.folder / "map.pcd", estimate.map);
    scenarios::write_prior_map(options.folder / scenarios::kPriorMapName, estimate.map);
  }
  if (!estimate.poses.empty()) write_replay(options.folder / "replay.html", recording, full_name(info), estimate);
  folder.keep();

  print_notes(session, recording, estimate);
  if (!options.prior_map.map.empty()) session.note(localisation_text(options.prior_map, estimate));
  scenarios::Outcome outcome;
  judge_without_truth(info, estimate, outcome);
  const nlohmann::json summary = summary_of(sensors, estimate, outcome.status, run_s);
  session.print({summary_table(summary)}, {{"folder", options.folder.string()},
                                           {"method", full_name(info)},
                                           {"status", to_string(outcome.status)},
                                           {"message", outcome.message.empty() ? "ok" : outcome.message},
                                           {"found", found_document(found)},
                                           {"summary", summary},
                                           {"health", estimate.health}});
  if (estimate.status.ok()) {
    session.note(
        fmt::format("written: {} (trajectory.tum, map.ply, map.pcd, map.tumblemap, estimate.json, replay.html, and "
                    "tables of rates, sweeps and covariances)",
                    options.folder.string()));
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
  auto options = std::make_shared<OdometryOptions>();
  declare_sensors(verb, options->input);
  verb.add("-o,--output", options->folder, "writes trajectory, map, health and replay page to this folder").required();
  verb.add_flag("--live", options->live, "uses past data only, as on the robot: runs slam/tumble_live");
  verb.add("--method", options->method,
           "runs this slam method ('tumble list methods') [default: slam/tumble; slam/tumble_lag with --map]");
  declare_prior_map(verb, options->prior_map);
  verb.add("--own-body", options->own_body_m,
           "sets a box around the robot by two opposite corners X Y Z X Y Z in lidar axes, m; drops returns inside the "
           "box [default: -0.5 -0.4 -0.27 0.5 0.4 0.23]")
      .words(6);
  verb.add("--set", options->parameters,
           "sets a parameter of the method: METHOD.PARAMETER=NUMBER; repeat the option for more parameters ('tumble "
           "list "
           "methods NAME' lists them)")
      .one_at_a_time();
  verb.footer(
      "Exit status: 0 estimate written, 1 estimate written but its health is 'diverged', 2 wrong use or bad input.");
  return [&session, options] { return run_odometry(session, *options); };
}

}  // namespace tumble::tools
