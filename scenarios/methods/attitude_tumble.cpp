// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <vector>

#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/report_rates.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"

namespace tumble::scenarios {

namespace {

TumbleAttitude::Params stated(const sim::Sensors& sensors) {
  TumbleAttitude::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  return params;
}

/// The attitude of a sphere comes from the merged readings of all IMUs in body axes; the rolling motion measures the
/// velocity.
Estimate run_sphere(const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate;
  estimate.frame = Frame::body;
  MergedImus imus;
  estimate.status = merge_imus(sensors, imus);
  add_findings(imus.merged.faults, imus.names, estimate);
  if (!estimate.status.ok()) return estimate;
  add_findings(check_merged_imus(checked_imu(sensors), imus.merged), imus.names, estimate);
  report_beyond_range(imus.beyond_range, estimate);
  TumbleAttitude::Params params = stated(sensors);
  params.radius_m = sensors.sphere_radius_m;
  params.lever_arm_m = imus.merged.lever_arm_m;
  attitude_tumble_settings().apply(parameters, params);
  const TumbleAttitude filter(params);
  TumbleAttitude::State state;
  estimate.attitudes.reserve(imus.merged.samples.size());
  for (const ImuSample& sample : imus.merged.samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, TumbleAttitude::attitude_covariance_rad2(state)});
    if (state.slipping) estimate.health["samples_slip"] += 1.0;
  }
  report_unknown_attitude(estimate);
  return estimate;
}

Estimate run_rig(const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const RecoveredRates recovered =
      recovered_readings(sensors, samples, ReadingsToReplace::unreliable_readings, estimate);
  TumbleAttitude::Params params = stated(sensors);
  attitude_tumble_settings().apply(parameters, params);
  const TumbleAttitude filter(params);
  TumbleAttitude::State state;
  estimate.attitudes.reserve(samples.size());
  std::vector<AngularRateState> turned(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    estimate.status = filter.step(recovered.samples[k], recovered.covariances_rad2_s2[k], state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({samples[k].time_ns, state.q_WI, TumbleAttitude::attitude_covariance_rad2(state)});
    turned[k].time_ns = samples[k].time_ns;
    turned[k].w_WI_I_rad_s = recovered.samples[k].angular_velocity_rad_s - state.bias_rad_s;
    turned[k].covariance_rad2_s2 = recovered.covariances_rad2_s2[k];
    turned[k].source = recovered.sources[k];
  }
  report_unknown_attitude(estimate);
  (void)check_imu(sensors, samples, turned, carried_share(recovered.report), estimate);
  return estimate;
}

}  // namespace

const Settings<TumbleAttitude::Params>& attitude_tumble_settings() {
  static const Settings<TumbleAttitude::Params> all(
      TumbleAttitude::Params{},
      {.stated = {"gravity_m_s2", "radius_m", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"}});
  return all;
}

void report_unknown_attitude(Estimate& estimate) {
  constexpr double kUnknown_rad = 0.5;
  double unknown_s = 0.0;
  TimeNs since_ns = 0;
  bool ended = true;
  for (std::size_t k = 1; k < estimate.attitudes.size(); ++k) {
    const AttitudeState &before = estimate.attitudes[k - 1], &here = estimate.attitudes[k];
    const double variance_rad2 = here.covariance_rad2.diagonal().head<2>().maxCoeff();
    ended = !(variance_rad2 > kUnknown_rad * kUnknown_rad);
    if (ended) continue;
    if (unknown_s == 0.0) since_ns = before.time_ns;
    unknown_s += seconds(here.time_ns - before.time_ns);
  }
  SensorHealth health;
  if (unknown_s > 0.0)
    health.add({HealthFinding::Kind::attitude_unknown, "", "",
                "time in s with an attitude standard deviation above 0.5 rad", unknown_s, 0.0, since_ns, ended});
  add_findings(health, {}, estimate);
}

namespace {

Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters,
                             const OracleInput& /*oracle*/) {
  return sensors.sphere_radius_m > 0.0 ? run_sphere(sensors, parameters) : run_rig(sensors, parameters);
}

}  // namespace

Method attitude_tumble() {
  return make_method({.name = "tumble",
                      .kind = Kind::attitude,
                      .doc = "Estimates tilt and gyro bias from constraints on the velocity: bounded in motion, "
                             "rolling without slip for a "
                             "sphere, zero at rest. Rates of clipped samples come from rate/tumble.",
                      .ours = true,
                      .settings = {&attitude_tumble_settings()}},
                     at_sample_times<run_attitude_tumble>);
}

}  // namespace tumble::scenarios
