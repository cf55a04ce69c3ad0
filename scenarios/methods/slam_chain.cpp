// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/slam_chain.hpp"

#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

LidarInertialOdometry::Params odometry_params(const sim::Sensors& sensors, const SlamStage& stage,
                                              const SlamChain& chain) {
  SlamParams params = stage.settings.defaults();
  LidarInertialOdometry::Params& odometry = params.odometry;
  odometry.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  odometry.expert.gravity_m_s2 = sensors.gravity_m_s2;
  const double accel_range_m_s2 = sensors.imus.front().stated_accel_range_m_s2;
  if (accel_range_m_s2 > 0.0) odometry.expert.saturated_imu.accel_m_s2 = max_unsaturated_reading(accel_range_m_s2);
  if (chain.along) {
    odometry.expert.matching.correction_max_m = chain.along->correction_max_m;
    odometry.expert.matching.correction_max_rad = chain.along->correction_max_rad;
  }
  stage.settings.apply(stage.parameters, params);
  return odometry;
}

bool append_sweeps(std::vector<MappedSweep>& sweeps, Estimate& estimate) {
  for (MappedSweep& sweep : sweeps) {
    SweepResult& report = sweep.result;
    if (sweep.status.error_code == ErrorCode::insufficient_data && report.trajectory.empty()) {
      leave_out_unfinished(estimate);
      continue;
    }
    if (leave_out_before_map(sweep.status, report, estimate)) continue;
    const TimeNs end_ns = report.pose.time_ns;
    if (!append_sweep(sweep.status, end_ns, std::move(report), estimate)) return false;
  }
  return true;
}

}  // namespace

Estimate begin_with_rates(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                          const std::function<Status(Estimate&)>& rates) {
  Estimate estimate;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = rates(estimate);
  if (!estimate.status.ok()) return estimate;
  const ImuHealthReport frozen = check_frozen(checked_imu(sensors), samples);
  report_findings(frozen.health, sensors, estimate);
  inflate_rates(frozen, samples, estimate);
  flag_saturated_forces(stated_rails(sensors.imus.front()), samples);
  return estimate;
}

LidarInertialOdometry::Params SlamParams::on_the_rig() {
  LidarInertialOdometry::Params params;
  params.own_body_L = presets::rig_body_L();
  params.expert.matching.agreeing_matches_min =
      RegistrationParams().expert.agreeing_matches_needed;  // disables with_few_matches
  return params;
}

SlamParams with_few_matches(SlamParams params) {
  params.odometry.expert.matching.agreeing_matches_min = MatchingParams().agreeing_matches_min;
  return params;
}

SlamParams with_calibration(SlamParams params) {
  const TumblingOdometry::Params door;
  params.odometry.mount_sigma_rad = door.mount_sigma_rad;
  params.odometry.mount_sigma_m = door.mount_sigma_m;
  params.odometry.time_offset_sigma_s = door.time_offset_sigma_s;
  params.odometry.expert.gravity_sigma_m_s2 = door.expert->mapping.expert.gravity_sigma_m_s2;
  return params;
}

Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed) {
  return Settings<SlamParams>(defaults, {.stated = {"gravity_m_s2", "accel_rail_m_s2"}, .fixed = std::move(fixed)});
}

bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate) {
  estimate.frame = Frame::imu;
  count_sources(estimate.rates, estimate.health);
  if (sensors.lidars.empty()) {
    estimate.status = {ErrorCode::empty, "lidars", 0.0, 1.0};
    return false;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  if (bridge::sweep_count(lidar) == 0) {
    estimate.status = {ErrorCode::empty, "lidar.sweep_start_ns", 0.0, 1.0};
    return false;
  }

  const LidarInertialOdometry::Params params = odometry_params(sensors, stage, chain);
  const MappingInput input{samples, estimate.rates, bridge::sweep_count(lidar),
                           [&](std::size_t k) {
                             if (chain.on_sweep && k > 0) chain.on_sweep(k, bridge::sweep_count(lidar));
                             bridge::Sweep sweep = bridge::sweep(lidar, k);
                             return WaitingSweep{sweep.start_ns, sweep.end_ns, std::move(sweep.points)};
                           },
                           chain.along ? chain.along->between : nullptr};
  MappedRecording mapped = chain.calibration ? map_with_calibration(input, params) : map_in_one_pass(input, params);
  for (std::size_t left = mapped.unfinished_sweeps; left > 0; --left) leave_out_unfinished(estimate);
  estimate.status = mapped.status;
  if (!append_sweeps(mapped.sweeps, estimate) || !estimate.status.ok()) return false;
  LidarScale scale;
  if (chain.calibration) scale = find_sweep_scale(samples, estimate.sweeps, sensors.gravity_m_s2);
  SensorHealth health;
  mapped.add_findings(scale, health);
  add_findings(health, {}, estimate);
  return conclude(mapped.mapper, estimate);
}

}  // namespace tumble::scenarios
