// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scenarios/baselines/mapping/pointwise_filter.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::PointwiseFilter::Params>& slam_pointwise_reject_settings() {
  static const Settings<baselines::PointwiseFilter::Params> all = [] {
    baselines::PointwiseFilter::Params params;
    params.own_body_L = presets::rig_body_L();
    return Settings<baselines::PointwiseFilter::Params>(params, {.stated = {"gravity_m_s2"}});
  }();
  return all;
}

void run_filter(const sim::Sensors& sensors, std::span<const ImuSample> samples, baselines::PointwiseFilter& filter,
                Estimate& estimate) {
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const double rail = unsaturated_range(sensors.imus.front().stated_accel_range_m_s2);
  std::size_t next = 0;
  // The IMU readings must include a sample at or after the sweep's end.
  const auto covers = [&](const bridge::Sweep& sweep) {
    while (next < samples.size() && (next == 0 || samples[next - 1].time_ns < sweep.end_ns)) {
      unsigned clipped = estimate.rates[next].clipped_axes;
      for (int axis = 0; axis < 3; ++axis) {
        if (rail > 0.0 && std::abs(samples[next].specific_force_m_s2[axis]) >= rail) clipped |= 8u << axis;
      }
      ImuSample sample = samples[next];
      sample.angular_velocity_rad_s = estimate.rates[next].w_WI_I_rad_s;
      estimate.status = filter.add_imu(sample, clipped);
      if (!estimate.status.ok()) return false;
      ++next;
    }
    return samples.back().time_ns >= sweep.end_ns && samples.front().time_ns <= sweep.end_ns;
  };
  const auto add = [&](const bridge::Sweep& sweep, SweepReport& report) {
    return filter.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, report);
  };
  if (run_over_sweeps(lidar, {covers, add}, estimate)) estimate.map = filter.map();
}

Estimate run_slam_pointwise_reject(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = start_at_rest(samples, start);
  if (estimate.status.ok()) estimate.status = railed_rates(sensors, samples, estimate.rates);
  if (!estimate.status.ok()) return estimate;
  if (sensors.lidars.empty() || bridge::sweep_count(sensors.lidars.front()) == 0) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return estimate;
  }
  for (RateState& rate : estimate.rates) rate.w_WI_I_rad_s -= start.gyro_bias_rad_s;

  baselines::PointwiseFilter::Params params = slam_pointwise_reject_settings().defaults();
  params.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  params.gravity_m_s2 = sensors.gravity_m_s2;
  slam_pointwise_reject_settings().apply(parameters, params);
  baselines::PointwiseFilter filter(params, start.q_WI);
  run_filter(sensors, samples, filter, estimate);
  return estimate;
}

}  // namespace

Method slam_pointwise_reject() {
  return rig_slam(
      {.name = "pointwise_reject",
       .doc =
           "Filter that processes each point at its own time and each IMU reading as a measurement of a random motion, "
           "without clipped axes. Not modelled: biases after the initial rest, gravity and mounting as states.",
       .source = "the family of Point-LIO, He et al., Advanced Intelligent Systems 2023",
       .settings = {&slam_pointwise_reject_settings()}},
      run_slam_pointwise_reject);
}

}  // namespace tumble::scenarios
