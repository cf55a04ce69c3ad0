// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"

namespace tumble::scenarios {

namespace {

const Settings<TumbleAttitude::Params>& attitude_tumble_settings() {
  static const Settings<TumbleAttitude::Params> all(
      TumbleAttitude::Params{},
      {.stated = {"gravity_m_s2", "radius_m", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"}});
  return all;
}

/// The inclination counts as unknown while its standard deviation exceeds 0.5 rad, for example after an IMU gap during
/// a tumble.
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
                "time in s during which the reported tilt standard deviation exceeds 0.5 rad", unknown_s, 0.0, since_ns,
                ended});
  add_findings(health, {}, estimate);
}

TumbleAttitude::Params stated(const sim::Sensors& sensors) {
  TumbleAttitude::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  return params;
}

/// For a sphere, the filter estimates the attitude from the merged readings of all IMUs in body axes. The rolling
/// velocity, computed from angular velocity and radius, is a velocity measurement of the filter.
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

Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters,
                             const OracleInput& /*oracle*/) {
  return sensors.sphere_radius_m > 0.0 ? run_sphere(sensors, parameters) : run_rig(sensors, parameters);
}

}  // namespace

Method attitude_tumble() {
  return make_method({.name = "tumble",
                      .kind = Kind::attitude,
                      .doc = "Estimates tilt and gyro bias with velocity constraints: bounded velocity in motion, zero "
                             "velocity at rest, and rolling without slip for a sphere. For other robots, the rates of "
                             "rate/tumble replace clipped and unreliable gyro readings.",
                      .ours = true,
                      .settings = {&attitude_tumble_settings()}},
                     at_sample_times<run_attitude_tumble>);
}

namespace {

Eigen::Matrix3d beyond_noise(const AngularRateState& rate) {
  const bool as_read = rate.clipped_axes == 0 && rate.source == AngularRateSource::measured;
  return as_read ? Eigen::Matrix3d::Zero() : rate.covariance_rad2_s2;
}

Estimate run_attitude_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters,
                                 const OracleInput& oracle) {
  Estimate estimate = rate_tumble_lag().run(sensors, {}, oracle);
  if (!estimate.status.ok()) return estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  TumbleAttitude::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  attitude_tumble_settings().apply(parameters, params);
  const TumbleAttitude filter(params);
  TumbleAttitude::State state;
  const std::vector<AngularRateState> rates = std::exchange(estimate.rates, {});
  estimate.attitudes.reserve(rates.size());
  std::size_t k = 0;
  for (const AngularRateState& rate : rates) {
    while (k < samples.size() && samples[k].time_ns < rate.time_ns) ++k;
    if (k == samples.size() || samples[k].time_ns != rate.time_ns) continue;
    ImuSample sample = samples[k];
    sample.angular_velocity_rad_s = rate.w_WI_I_rad_s;
    estimate.status = filter.step(sample, beyond_noise(rate), state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, TumbleAttitude::attitude_covariance_rad2(state)});
  }
  report_unknown_attitude(estimate);
  return estimate;
}

}  // namespace

Method attitude_tumble_lag() {
  return make_method({.name = "tumble_lag",
                      .kind = Kind::attitude,
                      .doc = "Applies the filter of attitude/tumble to the rates of rate/tumble_lag. The method is "
                             "causal and has the lag of "
                             "rate/tumble_lag.",
                      .ours = true,
                      .settings = {&attitude_tumble_settings()},
                      .robots = {"rig", "pendulum"}},
                     at_sample_times<run_attitude_tumble_lag>);
}

namespace {

void report_carried(const HandHeldSmoother::Report& report, std::map<std::string, double>& health) {
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
}

const Settings<HandHeldSmoother::Params>& carried_settings() {
  static const Settings<HandHeldSmoother::Params> all(HandHeldSmoother::Params{}, {.stated = {"gravity_m_s2"}});
  return all;
}

ClippedReadings find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health) {
  ClippingFinder::Params params;
  params.axis_limit_params = stated_rails(record);
  const ClippingFinder::ClippingSearchResult found = ClippingFinder(params).find(samples);
  report_rails(found.saturation_levels, health);
  return clipped_readings_of(samples, found);
}

HandHeldSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  HandHeldSmoother::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  carried_settings().apply(parameters, params);
  return params;
}

Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<AngularRateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health) {
  std::vector<ImuSample> samples;
  if (const Status status = bridge::primary_imu_samples(sensors, samples); !status.ok()) return status;
  const HandHeldSmoother::Params params = carried_params(sensors, parameters);
  const ClippedReadings known = find_clipped(sensors.imus.front(), samples, health);
  HandHeldSmoother::Report report;
  const Status status =
      HandHeldSmoother(params).estimate(samples, known.clipped_element_signs(), rates, attitudes, report);
  if (!status.ok()) return status;
  known.mark_partly_saturated(rates);
  report_carried(report, health);
  return status;
}

/// HandHeldSmoother also estimates the rates if the largest probability of hand-held motion in a recording is at least
/// kCarried. For hand-held motion, the rates of HandHeldSmoother are more accurate in clipped intervals.
constexpr double kCarried = 0.5;

Status run_thrown(const sim::Sensors& sensors, const sim::Values& parameters, const std::vector<ImuSample>& samples,
                  const RecoveredRates& recovered, std::vector<AngularRateState>& rates, Estimate& estimate) {
  const std::vector<Eigen::Matrix3d>& covariances = recovered.covariances_rad2_s2;
  ClippedReadings known = find_clipped(sensors.imus.front(), samples, estimate.health);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!covariances[k].isZero(0.0)) known.clip_signs[k].gyro = {};
  }
  SensingAxisClipSigns clipped = known.clipped_element_signs();
  clipped.recovered_covariance_rad2_s2 = covariances;
  HandHeldSmoother::Report report;
  const Status status = HandHeldSmoother(carried_params(sensors, parameters))
                            .estimate(recovered.samples, clipped, rates, estimate.attitudes, report);
  if (status.ok()) report_carried(report, estimate.health);
  return status;
}

std::vector<AngularRateState> rates_of(const RecoveredRates& recovered) {
  std::vector<AngularRateState> out(recovered.sources.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].time_ns = recovered.samples[k].time_ns;
    out[k].w_WI_I_rad_s = recovered.samples[k].angular_velocity_rad_s;
    out[k].covariance_rad2_s2 = recovered.covariances_rad2_s2[k];
    out[k].source = recovered.sources[k];
  }
  return out;
}

Estimate run_attitude_tumble_batch(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  RecoveredRates recovered;
  recovered.samples = samples;
  if (sensors.sphere_radius_m <= 0.0)
    recovered = recovered_readings(sensors, samples, ReadingsToReplace::clipped, estimate);
  std::vector<AngularRateState> rates;
  if (recovered.estimated && recovered.report.hand_held_probability_max < kCarried) {
    estimate.status = run_thrown(sensors, parameters, samples, recovered, rates, estimate);
  } else {
    estimate.status = run_carried(sensors, parameters, rates, estimate.attitudes, estimate.health);
  }
  if (!estimate.status.ok()) return estimate;
  report_unknown_attitude(estimate);
  // The health checks use the input of the attitude smoother, because the output of the smoother agrees with gravity at
  // rest even if the readings are wrong.
  (void)check_imu(sensors, samples, rates_of(recovered), carried_share(recovered.report), estimate);
  return estimate;
}

}  // namespace

Method attitude_tumble_batch() {
  return make_method({.name = "tumble_batch",
                      .kind = Kind::attitude,
                      .doc = "Smooths the complete recording of a hand-held body. The smoother assumes bounded "
                             "acceleration, velocity and position, and uses clipped gyro readings as bounds. If the "
                             "body is not hand-held, the rates of clipped samples come from rate/tumble.",
                      .ours = true,
                      .settings = {&carried_settings()}},
                     at_sample_times<run_attitude_tumble_batch>);
}

}  // namespace tumble::scenarios
