// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_baseline.hpp"

#include "scenarios/methods/bridge.hpp"

namespace tumble::scenarios {

SaturationLimitDetector::Params stated_rails(const sim::ImuRecord& record) {
  SaturationLimitDetector::Params rails;
  if (record.stated_gyro_range_rad_s > 0.0) rails.stated_gyro_range_rad_s = record.stated_gyro_range_rad_s;
  if (record.stated_accel_range_m_s2 > 0.0) rails.stated_accel_range_m_s2 = record.stated_accel_range_m_s2;
  return rails;
}

Estimate run_clipped_baseline(const Settings<baselines::ClippedBaseline::Params>& settings, const sim::Sensors& sensors,
                              const sim::Values& parameters) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const sim::ImuRecord& record = sensors.imus.front();
  baselines::ClippedBaseline::Params params = settings.defaults();
  params.rails = stated_rails(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  settings.apply(parameters, params);
  estimate.status = baselines::ClippedBaseline(params).estimate(samples, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace tumble::scenarios
