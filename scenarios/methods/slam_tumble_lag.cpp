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
#include "scenarios/methods/report_rails.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/slam_conclusion.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

// The lever arm of zero is a placeholder; the recording states the lever arm.
TumblingOdometry::Params lag_defaults() {
  TumblingOdometry::Params out;
  out.lever_arm_I_m.setZero();
  return out;
}

const Settings<TumblingOdometry::Params>& slam_tumble_lag_settings() {
  static const Settings<TumblingOdometry::Params> all(
      lag_defaults(),
      {.stated = {"imu_*", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m", "gravity_m_s2",
                  "mapping_accel_rail_m_s2"},
       // TumblingOdometry has its own parameters for these quantities, so the rate stage's parameters are fixed.
       .fixed = {"rate_lever_arm_sigma_m", "rate_gyro_noise_density", "rate_accel_noise_density", "rate_rails_stated_*",
                 "rate_period_s", "rate_lag_s", "rate_evidence_gravity_m_s2", "rate_carried_gravity_m_s2",
                 "rate_carried_gap_max_s", "rate_carried_period_s", "rate_carried_lag_s", "rate_carried_iterations_max",
                 "mapping_mount_sigma_*", "mapping_time_offset_sigma_s", "mapping_gravity_m_s2", "mapping_range_*",
                 "mapping_own_body_*"}});
  return all;
}

TumblingOdometry::Params stated_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  const sim::ImuRecord& imu = sensors.imus.front();
  TumblingOdometry::Params params = slam_tumble_lag_settings().defaults();
  params.imu = bridge::imu_sheet(imu);
  params.lever_arm_I_m = bridge::lever_arm_I_m(imu);
  params.T_IL = bridge::T_IL(imu, sensors.lidars.front());
  params.own_body_L = presets::rig_body_L();
  params.expert.gravity_m_s2 = sensors.gravity_m_s2;
  slam_tumble_lag_settings().apply(parameters, params);
  return params;
}

/// Selects which output of TumblingOdometry becomes the estimate.
enum class Word {
  live,  ///< pose at each IMU sample, as soon as the sample is processed
  last,  ///< final trajectory of each sweep
};

/// Collects the output of TumblingOdometry in an estimate.
class Listener {
 public:
  Listener(Word word, const TumblingOdometry::Params& params, Estimate& estimate)
      : word_(word),
        given_(params.stated_calibration()),
        localisation_(params.expert.mapping.expert.matching.distance_m),
        estimate_(estimate) {}

  /// Stores the live pose after each processed sample.
  void observe(const TumblingOdometry& odometry) {
    PoseState pose;
    if (word_ != Word::live || !odometry.newest(pose).ok()) return;
    // While TumblingOdometry delays a sample, its newest pose belongs to the previous sample.
    if (live_.empty() || pose.time_ns > live_.back().time_ns) live_.push_back(pose);
  }
  void take(TumblingOdometry& odometry) {
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      if (sweep->report.trajectory.empty()) {  // the IMU starts after the sweep
        count_trouble(sweep->status, estimate_);
        continue;
      }
      std::vector<PoseState> smoothed = std::move(sweep->report.smoothed);
      const TimeNs end_ns = sweep->report.pose.time_ns;
      localisation_.add(sweep->report);
      append_sweep(sweep->status, end_ns, std::move(sweep->report), estimate_);
      apply_next(std::move(smoothed));
    }
  }
  /// Stores the remaining trajectories at the end of the run.
  void conclude(const TumblingOdometry& odometry) {
    for (std::vector<PoseState>& open : odometry.mapper().window_trajectories()) apply_next(std::move(open));
    if (word_ == Word::live) speak_live();
    conclude_sweeps(odometry.mapper(), given_, odometry.sweep_scale(), localisation_, estimate_);
  }

 private:
  void apply_next(std::vector<PoseState> smoothed) {
    if (smoothed.empty() || smoothed_ == estimate_.sweeps.size()) return;
    apply_smoothed(std::move(smoothed), estimate_.sweeps[smoothed_++]);
  }

  /// Replaces the trajectory of each sweep by its live poses. Sweeps before the first live pose (at rest about 0.3 s
  /// after the start) are unchanged.
  void speak_live() {
    auto next = live_.begin();
    for (SweepReport& sweep : estimate_.sweeps) {
      const TimeNs end_ns = sweep.pose.time_ns;
      const auto after = std::find_if(next, live_.end(), [&](const PoseState& pose) { return pose.time_ns > end_ns; });
      if (after == next) continue;
      sweep.trajectory.assign(next, after);
      sweep.pose = sweep.trajectory.back();
      next = after;
    }
  }

  Word word_;
  StatedCalibration given_;
  Localisation localisation_;
  Estimate& estimate_;
  std::size_t smoothed_ = 0;
  std::vector<PoseState> live_;
};

/// Passes the recording to TumblingOdometry in real-time order: each sample at the end of its window, each sweep after
/// its last point. Counts the sweeps that end after the last sample in `estimate`.
Status replay(const sim::Sensors& sensors, std::span<const ImuSample> samples, TumblingOdometry& odometry,
              Listener& listener, Estimate& estimate) {
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const std::size_t sweeps = bridge::sweep_count(lidar);
  std::optional<bridge::Sweep> present;
  std::size_t next = 0;
  for (const ImuSample& sample : samples) {
    if (Status status = odometry.add_imu(sample); !status.ok()) return status;
    while (present || next < sweeps) {
      if (!present) present = bridge::sweep(lidar, next++);
      if (present->end_ns > sample.time_ns) break;
      if (Status status = odometry.add_sweep(present->start_ns, present->end_ns, present->points); !status.ok())
        return status;
      present.reset();
    }
    listener.observe(odometry);
    listener.take(odometry);
  }
  odometry.finish();
  listener.take(odometry);
  for (std::size_t left = sweeps - next + (present ? 1 : 0); left > 0; --left) leave_out_unfinished(estimate);
  return {};
}

void report_prior_map(Estimate& estimate) {
  const auto first = std::find_if(estimate.sweeps.begin(), estimate.sweeps.end(),
                                  [](const SweepReport& sweep) { return sweep.in_prior_map; });
  const bool localised = first != estimate.sweeps.end();
  estimate.health["prior_map_sweep"] = localised ? static_cast<double>(first - estimate.sweeps.begin()) : 0.0;
}

Estimate run_slam_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, Word word,
                             const PriorMap* map = nullptr) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  if (sensors.lidars.empty()) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return estimate;
  }
  (void)check_imu(sensors, samples, estimate);  // Only a warning, as for attitudes.
  (void)check_flights(sensors, samples, std::nullopt, estimate);
  (void)report_frozen_axes(sensors, samples, estimate);
  const TumblingOdometry::Params params = stated_params(sensors, parameters);
  TumblingOdometry odometry(params);
  if (map != nullptr) estimate.status = odometry.use_map(*map);
  if (!estimate.status.ok()) return estimate;
  Listener listener(word, params, estimate);
  estimate.status = replay(sensors, samples, odometry, listener, estimate);
  if (!estimate.status.ok()) return estimate;
  report_rails(odometry.rails(), estimate.health);
  const std::size_t left_out = sensors.imus.front().time_ns.size() - samples.size();
  estimate.health["rejected_readings"] = static_cast<double>(left_out + odometry.rejected_readings());
  if (odometry.early_sweeps() > 0) estimate.health["sweeps_before_imu"] = static_cast<double>(odometry.early_sweeps());
  estimate.health["gaps"] = static_cast<double>(odometry.gaps());
  estimate.health["second_pass_applied"] = odometry.second_pass_applied() ? 1.0 : 0.0;
  listener.conclude(odometry);
  if (map != nullptr) report_prior_map(estimate);
  return estimate;
}

}  // namespace

Method slam_tumble_lag() {
  return rig_slam({.name = "tumble_lag",
                   .doc = "TumblingOdometry, the public API of the library: one causal pass; the final pose of a sweep "
                          "follows 0.3 s later.",
                   .ours = true,
                   .settings = {&slam_tumble_lag_settings()}},
                  [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
                    return run_slam_tumble_lag(sensors, parameters, Word::last);
                  });
}

std::optional<Method> localised_in(const Method& method, std::shared_ptr<const PriorMap> map) {
  const bool live = method.info.name == "tumble_live";
  if (method.info.kind != Kind::slam || (!live && method.info.name != "tumble_lag")) return std::nullopt;
  Method out = method;
  out.run = [info = method.info, word = live ? Word::live : Word::last, map = std::move(map)](
                const sim::Sensors& sensors, const sim::Values& given, const OracleInput&) {
    const std::string name = "method " + full_name(info);
    try {
      return run_slam_tumble_lag(sensors, resolve_settings(name, given, info.settings), word, map.get());
    } catch (const sim::InvalidSituation& error) {
      throw BadInput(error.what());
    } catch (const InvalidParams& error) {
      throw BadInput(name + ": " + error.what());
    }
  };
  return out;
}

Method slam_tumble_live() {
  return rig_slam({.name = "tumble_live",
                   .doc = "The same pass, live: the pose at each IMU sample uses past data only.",
                   .ours = true,
                   .settings = {&slam_tumble_lag_settings()}},
                  [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
                    return run_slam_tumble_lag(sensors, parameters, Word::live);
                  });
}

}  // namespace tumble::scenarios
