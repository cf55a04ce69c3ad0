// SPDX-License-Identifier: BSD-3-Clause

#include "scenarios/baselines/angular_velocity/magnetometer_rate.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::MagnetometerRate::Params>& rate_magnetometer_settings() {
  static const Settings<baselines::MagnetometerRate::Params> all(baselines::MagnetometerRate::Params{},
                                                                 {.stated = {"gyro_noise_density", "earth_field_t"}});
  return all;
}

Estimate run_rate_magnetometer(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const sim::ImuRecord& record = sensors.imus.front();
  baselines::MagnetometerRate::Params params;
  params.rails = stated_rails(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  params.earth_field_t = record.earth_field_W_t.norm();
  rate_magnetometer_settings().apply(parameters, params);
  estimate.status = baselines::MagnetometerRate(params).estimate(samples, record.magnetic_field_t, estimate.rates);
  estimate.health["magnetometers"] = record.magnetic_field_t.empty() ? 0.0 : 1.0;
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_magnetometer() {
  MethodInfo info;
  info.name = "magnetometer";
  info.kind = Kind::rate;
  info.doc =
      "Extended Kalman filter on the rotation of the magnetic field and the unclipped gyro axes. Made for fast spin "
      "across an undisturbed field; without a magnetometer, only smoothness constrains the rate.";
  info.source = "the family of Tan's filters for spinning bodies";
  info.settings = {&rate_magnetometer_settings()};
  return make_method(std::move(info), run_rate_magnetometer);
}

}  // namespace tumble::scenarios
