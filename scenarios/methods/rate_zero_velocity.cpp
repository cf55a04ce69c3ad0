// SPDX-License-Identifier: BSD-3-Clause

#include "scenarios/baselines/angular_velocity/standstill_smoother.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::StandstillSmoother::Params>& rate_zero_velocity_settings() {
  static const Settings<baselines::StandstillSmoother::Params> all(
      baselines::StandstillSmoother::Params{},
      {.stated = {"gravity_m_s2", "gyro_noise_density", "accel_noise_density"}});
  return all;
}

Estimate run_rate_zero_velocity(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const sim::ImuRecord& record = sensors.imus.front();
  baselines::StandstillSmoother::Params params;
  params.rails = stated_rails(record);
  params.gravity_m_s2 = sensors.gravity_m_s2;
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  if (record.accel_noise_m_s2_sqrt_hz > 0.0) params.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
  rate_zero_velocity_settings().apply(parameters, params);
  estimate.status = baselines::StandstillSmoother(params).estimate(samples, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_zero_velocity() {
  MethodInfo info;
  info.name = "zero_velocity";
  info.kind = Kind::rate;
  info.doc =
      "Integrates the IMU and smooths the result with the zero velocity and zero rate of standstills. The method is "
      "made for motions of one or two seconds from rest to rest that clip a few samples (steps, hand motion). After "
      "several rotations, tilt and velocity do not determine the clipped rate.";
  info.source = "similar to the smoothers of Dang and Suh for inertial sensors between zero-velocity intervals";
  info.settings = {&rate_zero_velocity_settings()};
  return make_method(std::move(info), run_rate_zero_velocity);
}

}  // namespace tumble::scenarios
