// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

Settings<TumblingOdometry::Params> odometry_settings(double lag_s, std::vector<std::string> fixed) {
  TumblingOdometry::Params params;
  params.lever_arm_I_m.setZero();  // the recording contains the lever arm
  params.lag_s = lag_s;
  params.expert->mapping.own_body_L = presets::rig_body_L();
  fixed.insert(fixed.end(),
               {"rate_lever_arm_sigma_m", "rate_gyro_noise_density", "rate_accel_noise_density", "rate_period_s",
                "rate_lag_s", "rate_evidence_gravity_m_s2", "rate_carried_gravity_m_s2", "rate_carried_gap_max_s",
                "rate_carried_period_s", "rate_carried_lag_s", "mapping_mount_sigma_*", "mapping_time_offset_sigma_s",
                "mapping_gravity_m_s2", "mapping_range_*"});
  return Settings<TumblingOdometry::Params>(
      params, {.stated = {"imu_*", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m", "gravity_m_s2",
                          "mapping_accel_rail_m_s2"},
               .fixed = std::move(fixed)});
}

const Settings<TumblingOdometry::Params>& whole_settings() {
  static const auto all =
      odometry_settings(TumblingOdometry::kWholeRecording,
                        {"lag_s", "sweeps_max", "second_pass_*", "rate_accel_bias_sigma_m_s2", "rate_inertia_sigma",
                         "rate_step_s", "rate_bound_*", "rate_rig_inflation*", "rate_contact_inflation",
                         "rate_contact_slopes", "rate_uncalibrated", "rate_carried_window_s"});
  return all;
}

const Settings<TumblingOdometry::Params>& lag_settings() {
  static const auto all = odometry_settings(TumblingOdometry::Params{}.lag_s, {"rate_carried_iterations_max"});
  return all;
}

TumblingOdometry::Params stated_params(const sim::Sensors& sensors, TumblingOdometry::Params params) {
  const sim::ImuRecord& imu = sensors.imus.front();
  params.imu = bridge::imu_sheet(imu);
  params.lever_arm_I_m = bridge::lever_arm_I_m(imu);
  params.T_IL = bridge::T_IL(imu, sensors.lidars.front());
  params.expert->gravity_m_s2 = sensors.gravity_m_s2;
  return params;
}

enum class SlamOutput {
  live,   ///< live pose at each IMU sample
  lag,    ///< final trajectory after a fixed lag
  whole,  ///< final trajectory from the whole recording
};

using SweepProgress = TumblingOdometry::SweepProgress;

class Collector {
 public:
  Collector(SlamOutput output, std::string imu, Estimate& estimate)
      : output_(output), estimate_(estimate), names_{std::move(imu)} {}

  void observe(const TumblingOdometry& odometry) {
    PoseState pose;
    if (output_ != SlamOutput::live || !odometry.newest(pose).ok()) return;
    if (live_.empty() || pose.time_ns > live_.back().time_ns) live_.push_back(pose);
    const LidarInertialOdometry& mapper = odometry.mapper();
    if (!live_in_prior_map_ns_ && mapper.prior_map() != nullptr && mapper.check_localised().ok())
      live_in_prior_map_ns_ = pose.time_ns;
  }
  void take(TumblingOdometry& odometry) {
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      if (sweep->result.trajectory.empty()) {  // the IMU starts after the sweep
        count_trouble(sweep->status, estimate_);
        continue;
      }
      std::vector<PoseState> smoothed = std::move(sweep->result.final_poses_of_earlier_sweep);
      const bool in_prior_map = sweep->result.in_prior_map;
      const TimeNs end_ns = sweep->result.pose.time_ns;
      found_.add_current_and_end_others(odometry.health());
      append_sweep(sweep->status, end_ns, std::move(sweep->result), estimate_);
      apply_next(std::move(smoothed), in_prior_map);
    }
  }
  void conclude(const TumblingOdometry& odometry) {
    if (output_ != SlamOutput::whole) {
      const bool in_prior_map = odometry.mapper().prior_map() != nullptr && odometry.mapper().check_localised().ok();
      for (std::vector<PoseState>& open : odometry.mapper().window_trajectories())
        apply_next(std::move(open), in_prior_map);
    }
    if (output_ == SlamOutput::live) replace_by_live();
    found_.add_current_and_end_others(odometry.health());
    add_findings(found_, names_, estimate_);
    if (odometry.mapper().prior_map() != nullptr) report_localised(estimate_);
    const bool localised = report_prior_map_sweep(odometry.mapper());
    if (output_ == SlamOutput::lag && localised) convert_to_prior_map_frame(odometry.mapper());
    scenarios::conclude(odometry.mapper(), estimate_);
    if (localised) leave_out_local_frame();
  }

 private:
  void apply_next(std::vector<PoseState> smoothed, bool in_prior_map) {
    if (smoothed.empty() || smoothed_ == estimate_.sweeps.size()) return;
    if (output_ != SlamOutput::live) estimate_.sweeps[smoothed_].in_prior_map = in_prior_map;  // else: live poses
    apply_smoothed(std::move(smoothed), estimate_.sweeps[smoothed_++]);
  }

  bool report_prior_map_sweep(const LidarInertialOdometry& mapper) {
    if (mapper.prior_map() == nullptr) return false;
    const auto first =
        std::ranges::find_if(estimate_.sweeps, [](const SweepResult& sweep) { return sweep.in_prior_map; });
    const bool localised = first != estimate_.sweeps.end();
    estimate_.health["prior_map_sweep"] = localised ? static_cast<double>(first - estimate_.sweeps.begin() + 1) : 0.0;
    return localised;
  }

  /// All poses of a trajectory are in one frame, so live poses before the localisation are left out.
  void leave_out_local_frame() {
    if (live_in_prior_map_ns_)
      std::erase_if(estimate_.poses, [&](const PoseState& pose) { return pose.time_ns < *live_in_prior_map_ns_; });
    std::erase_if(estimate_.faults.findings, [](const HealthFinding& finding) {
      return finding.kind == HealthFinding::Kind::not_localised && finding.ended;
    });
  }

  void convert_to_prior_map_frame(const LidarInertialOdometry& mapper) {
    for (SweepResult& sweep : estimate_.sweeps) {
      if (sweep.in_prior_map || !mapper.convert_to_prior_map_frame(sweep.trajectory).ok()) continue;
      sweep.pose = sweep.trajectory.back();
      sweep.in_prior_map = true;
    }
  }

  void replace_by_live() {
    auto next = live_.begin();
    for (SweepResult& sweep : estimate_.sweeps) {
      const TimeNs end_ns = sweep.pose.time_ns;
      const auto after = std::find_if(next, live_.end(), [&](const PoseState& pose) { return pose.time_ns > end_ns; });
      if (after == next) continue;
      sweep.trajectory.assign(next, after);
      sweep.pose = sweep.trajectory.back();
      sweep.in_prior_map = live_in_prior_map_ns_ && sweep.trajectory.front().time_ns >= *live_in_prior_map_ns_;
      next = after;
    }
  }

  SlamOutput output_;
  Estimate& estimate_;
  std::vector<std::string> names_;
  SensorHealth found_;
  std::size_t smoothed_ = 0;
  std::vector<PoseState> live_;
  std::optional<TimeNs> live_in_prior_map_ns_;  // time of the first live pose in the frame of the prior map
};

/// Replays IMU samples at the end of their averaging windows, and sweeps after their last points, as in real time. A
/// sweep that ends after the last IMU sample is used only if the estimate may use the whole recording (`whole`).
Status replay(const sim::Sensors& sensors, const bridge::DeliveredSamples& delivered, bool whole,
              TumblingOdometry& odometry, Collector& collector, const SweepProgress& on_sweep, std::size_t& rejected,
              Estimate& estimate) {
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const std::size_t sweeps = bridge::sweep_count(lidar);
  std::optional<bridge::Sweep> present;
  std::size_t next = 0;
  const auto add_sweep = [&](const bridge::Sweep& sweep) {
    return odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points);
  };
  for (std::size_t k = 0; k < delivered.samples.size(); ++k) {
    const TimeNs now_ns = delivered.arrival_ns[k];
    const TimeNs gap_ns = k > 0 ? now_ns - delivered.arrival_ns[k - 1] : 0;
    while (seconds(gap_ns) > bridge::kGapMaxS && (present || next < sweeps)) {
      if (!present) present = bridge::sweep(lidar, next++);
      if (present->end_ns > now_ns) break;
      if (!add_sweep(*present).ok()) estimate.health["sweeps_without_imu"] += 1.0;
      present.reset();
    }
    if (const Status status = odometry.add_imu(delivered.samples[k]);
        !status.ok() && status.error_code != ErrorCode::gap)
      ++rejected;
    while (present || next < sweeps) {
      if (!present) present = bridge::sweep(lidar, next++);
      if (present->end_ns > now_ns) break;
      if (Status status = add_sweep(*present); !status.ok()) return status;
      present.reset();
      if (!whole && on_sweep) on_sweep(next, sweeps);
    }
    collector.observe(odometry);
    collector.take(odometry);
  }
  while (present || next < sweeps) {
    if (!present) present = bridge::sweep(lidar, next++);
    if (!whole || !add_sweep(*present).ok()) leave_out_unfinished(estimate);
    present.reset();
  }
  const Status status = odometry.finish(on_sweep);
  collector.take(odometry);
  return status;
}

void report_whole(const WholeRecordingEstimate& whole, const sim::Sensors& sensors, Estimate& estimate) {
  estimate.rates = whole.rates;
  estimate.suspect_rad2_s2 = whole.suspected_error_covariance_rad2_s2;
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) estimate.rates[k].time_ns = whole.stamps_ns[k];
  report_rates(whole.report, estimate);
  report_findings(whole.findings.health, sensors, estimate);
  count_sources(estimate.rates, estimate.health);
  if (whole.mapped_recording.calibration_replaced) {
    estimate.health["lidar_calibration_replaced"] = 1.0;
    estimate.replaced_T_BL = sensors.imus.front().T_BI * whole.mapped_recording.mapper.lidar_calibration().T_IL;
  }
  if (whole.corrected_jitter_s > 0.0) estimate.health["time_stamps_corrected_s"] = whole.corrected_jitter_s;
  for (std::size_t left = whole.mapped_recording.unfinished_sweeps; left > 0; --left) leave_out_unfinished(estimate);
}

void report_stream(const TumblingOdometry& odometry, Estimate& estimate) {
  report_rails(odometry.saturation_levels(), estimate.health);
  estimate.health["second_pass_applied"] = odometry.first_seconds_reprocessing_applied() ? 1.0 : 0.0;
}

Estimate run(SlamOutput output, const Settings<TumblingOdometry::Params>& settings, const sim::Sensors& sensors,
             const sim::Values& parameters, const SweepProgress& on_sweep, const PriorMap* map = nullptr) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  bridge::DeliveredSamples delivered;
  if (sensors.imus.empty()) {
    estimate.status = {ErrorCode::empty, "imus", 0.0, 1.0};
    return estimate;
  }
  estimate.status = bridge::delivered_samples(sensors.imus.front(), delivered);
  if (!estimate.status.ok()) return estimate;
  if (sensors.lidars.empty() || bridge::sweep_count(sensors.lidars.front()) == 0) {
    const char* const missing = sensors.lidars.empty() ? "lidars" : "lidar.sweep_start_ns";
    estimate.status = {ErrorCode::empty, missing, 0.0, 1.0};
    return estimate;
  }
  TumblingOdometry::Params params = stated_params(sensors, settings.defaults());
  settings.apply(parameters, params);
  params.own_body_L = params.expert->mapping.own_body_L;
  TumblingOdometry odometry(params);
  if (map != nullptr) estimate.status = odometry.set_prior_map(*map);
  if (!estimate.status.ok()) return estimate;
  Collector collector(output, sensors.imus.front().name, estimate);
  std::size_t rejected = 0;
  estimate.status =
      replay(sensors, delivered, output == SlamOutput::whole, odometry, collector, on_sweep, rejected, estimate);
  if (odometry.whole_recording_result()) report_whole(*odometry.whole_recording_result(), sensors, estimate);
  if (!estimate.status.ok()) return estimate;
  rejected += odometry.rejected_readings();
  if (output != SlamOutput::whole || rejected > 0) estimate.health["rejected_readings"] = static_cast<double>(rejected);
  if (odometry.sweeps_before_first_imu() > 0)
    estimate.health["sweeps_before_imu"] = static_cast<double>(odometry.sweeps_before_first_imu());
  if (output != SlamOutput::whole || odometry.restart_count() > 0)
    estimate.health["gaps"] = static_cast<double>(odometry.restart_count());
  if (output != SlamOutput::whole) report_stream(odometry, estimate);
  collector.conclude(odometry);
  return estimate;
}

Estimate run_whole(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& input) {
  return run(SlamOutput::whole, whole_settings(), sensors, parameters, input.on_sweep);
}

Estimate run_lag(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& input) {
  return run(SlamOutput::lag, lag_settings(), sensors, parameters, input.on_sweep);
}

Estimate run_live(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& input) {
  return run(SlamOutput::live, lag_settings(), sensors, parameters, input.on_sweep);
}

}  // namespace

Method slam_tumble() {
  return make_method(
      {.name = "tumble",
       .kind = Kind::slam,
       .doc = "Runs TumblingOdometry (public API) on the whole recording, and repeats the mapping until the "
              "calibration has converged.",
       .ours = true,
       .settings = {&whole_settings()},
       .robots = {"rig"}},
      run_whole);
}

Method slam_tumble_lag() {
  return make_method({.name = "tumble_lag",
                      .kind = Kind::slam,
                      .doc = "Runs TumblingOdometry (public API) in one causal pass. The final pose of a sweep is in "
                             "the result of the next sweep.",
                      .ours = true,
                      .settings = {&lag_settings()},
                      .robots = {"rig"}},
                     run_lag);
}

std::optional<Method> localised_in(const Method& method, std::shared_ptr<const PriorMap> map) {
  const bool live = method.info.name == "tumble_live";
  if (method.info.kind != Kind::slam || (!live && method.info.name != "tumble_lag")) return std::nullopt;
  Method out = method;
  out.run = with_settings(method.info,
                          [output = live ? SlamOutput::live : SlamOutput::lag, map = std::move(map)](
                              const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& input) {
                            return run(output, lag_settings(), sensors, parameters, input.on_sweep, map.get());
                          });
  return out;
}

Method slam_tumble_live() {
  return make_method(
      {.name = "tumble_live",
       .kind = Kind::slam,
       .doc = "Runs TumblingOdometry (public API) live: the pose at each IMU sample uses past data only.",
       .ours = true,
       .settings = {&lag_settings()},
       .robots = {"rig"}},
      run_live);
}

}  // namespace tumble::scenarios
