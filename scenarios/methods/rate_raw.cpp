// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

Estimate run_rate_raw(const sim::Sensors& sensors, const sim::Values&, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = raw_rates(sensors, samples, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<AngularRateState>& out) {
  out.assign(samples.size(), {});
  const double variance = bridge::gyro_variance_rad2_s2(sensors.imus.front());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out[k].time_ns = samples[k].time_ns;
    out[k].w_WI_I_rad_s = samples[k].angular_velocity_rad_s;
    out[k].covariance_rad2_s2 = variance * Eigen::Matrix3d::Identity();
    out[k].clipped_axes = samples[k].device_clip_flags & kClipGyro;
    out[k].source = out[k].clipped_axes ? AngularRateSource::lower_bound_only : AngularRateSource::measured;
  }
  return {};
}

Method rate_raw() {
  MethodInfo info;
  info.name = "raw";
  info.kind = Kind::rate;
  info.doc =
      "Returns the gyro readings of the primary IMU unchanged, including clipped readings; the variance is the noise "
      "of the data sheet.";
  info.source = "baseline without a method";
  info.baseline = true;
  return make_method(std::move(info), run_rate_raw);
}

}  // namespace tumble::scenarios
