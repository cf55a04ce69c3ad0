// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/baselines/angular_velocity/magnetometer_rate.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 6> kParameters = {{
    {"field_noise_t", 5e-8, 1e-12, 1e-3, "T", "noise of one reading: 0.5 mG, MTi-300 sheet of May 2023"},
    {"hard_iron_t", 1e-6, 0.0, 1e-3, "T", "offset of the magnetometer, one standard deviation"},
    {"disturbance_t_sqrt_s", 1e-6, 0.0, 1.0, "T/sqrt(s)", "change of the field along the way"},
    {"disturbed_share", 0.02, 1e-4, 10.0, "1", "deviation of the field's length that doubles that change in power"},
    {"jerk_psd_rad2_s5", 1e7, 1.0, 1e12, "rad^2/s^5", "density of the white angular jerk"},
    kTiltedRails,
}};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const sim::ImuRecord& record = sensors.imus.front();
  baselines::MagnetometerRate::Params params;
  params.rails = stated_rails(record);
  params.tilted_rails = parameters.at("tilted_rails") > 0.5;
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  params.field_noise_t = parameters.at("field_noise_t");
  params.hard_iron_t = parameters.at("hard_iron_t");
  params.earth_field_t = record.earth_field_W_t.norm();
  params.disturbance_t_sqrt_s = parameters.at("disturbance_t_sqrt_s");
  params.disturbed_share = parameters.at("disturbed_share");
  params.jerk_psd = parameters.at("jerk_psd_rad2_s5");
  params.gap_max_s = bridge::kGapMaxS;
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
      "An extended Kalman filter that follows the turning of the magnetic field beside the gyro's free axes. Made for "
      "fast spin across the field in the open; without a magnetometer in the recording smoothness alone is left.";
  info.source = "the family of Tan's filters for spinning bodies";
  info.parameters = kParameters;
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
