// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"

namespace tumble::scenarios {

namespace {

Eigen::Matrix3d beyond_noise(const AngularRateState& rate) {
  const bool as_read = rate.clipped_axes == 0 && rate.source == AngularRateSource::measured;
  return as_read ? Eigen::Matrix3d::Zero() : rate.covariance_rad2_s2;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
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
                     at_sample_times<run>);
}

}  // namespace tumble::scenarios
