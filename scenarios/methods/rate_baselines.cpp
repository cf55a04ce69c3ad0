// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_baselines.hpp"

#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sample_times.hpp"

namespace tumble::scenarios {

namespace {

using SaaveParams = SaturationAwareRateEstimator::Params;

Settings<SaaveParams> saave_settings(SettingsOptions options) {
  SaaveParams params;
  params.lever_arm_m = presets::rig_lever_arm_m();
  params.saturation_point_rad_s = presets::kRigSaturationPoint_rad_s;
  options.stated = {"lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"};
  return Settings<SaaveParams>(params, std::move(options));
}

const Settings<SaaveParams>& rate_saave_settings() {
  static const Settings<SaaveParams> all = saave_settings({});
  return all;
}

const Settings<baselines::ClippedBaseline::Params>& rate_interpolate_settings() {
  static const Settings<baselines::ClippedBaseline::Params> all(baselines::ClippedBaseline::Params{},
                                                                {.stated = {"gyro_noise_density"}});
  return all;
}

Status interpolated_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                          const sim::Values& parameters, std::vector<AngularRateState>& out) {
  const sim::ImuRecord& record = sensors.imus.front();
  baselines::ClippedBaseline::Params params = rate_interpolate_settings().defaults();
  params.rails = stated_rails(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  rate_interpolate_settings().apply(parameters, params);
  return baselines::ClippedBaseline(params).estimate(samples, out);
}

template <typename Rates>
Estimate estimate_of_primary_imu(const sim::Sensors& sensors, const Rates& rates) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = rates(samples, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

Estimate run_rate_raw(const sim::Sensors& sensors, const sim::Values&, const OracleInput&) {
  return estimate_of_primary_imu(sensors,
                                 [&](const auto& samples, auto& out) { return raw_rates(sensors, samples, out); });
}

Estimate run_rate_interpolate(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return estimate_of_primary_imu(
      sensors, [&](const auto& samples, auto& out) { return interpolated_rates(sensors, samples, parameters, out); });
}

Estimate run_rate_saave(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return estimate_of_primary_imu(sensors, [&](const auto& samples, auto& out) {
    return saave_rates(sensors, samples, rate_saave_settings(), parameters, out);
  });
}

Estimate run_rate_oracle(const sim::Sensors& sensors, const sim::Values&, const OracleInput& oracle) {
  Estimate estimate;
  estimate.status = unclipped_rates(sensors, *oracle.truth, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

SaturationLimitDetector::Params stated_rails(const sim::ImuRecord& record) {
  SaturationLimitDetector::Params rails;
  if (record.stated_gyro_range_rad_s > 0.0) rails.stated_gyro_range_rad_s = record.stated_gyro_range_rad_s;
  if (record.stated_accel_range_m_s2 > 0.0) rails.stated_accel_range_m_s2 = record.stated_accel_range_m_s2;
  return rails;
}

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

Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<AngularRateState>& out) {
  out.clear();
  // Like all other methods, the oracle `rate/oracle` must reject a recording with invalid clipped readings, although
  // the oracle only uses the unclipped readings.
  std::vector<ImuSample> samples;
  Status status = bridge::primary_imu_samples(sensors, samples);
  if (!status.ok()) return status;
  if (truth.imus.empty())
    throw BadInput("this method needs unclipped IMU readings, but the truth contains no IMU readings");
  status = bridge::unclipped_samples(sensors.imus.front(), truth.imus.front(), samples);
  if (!status.ok()) return status;
  return raw_rates(sensors, samples, out);
}

Settings<SaaveParams> other_saave_settings(std::span<const sim::Parameter> others) {
  return saave_settings({.beside = others, .prefix = "rate_"});
}

Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<SaaveParams>& settings, const sim::Values& parameters,
                   std::vector<AngularRateState>& out) {
  SaaveParams params = settings.defaults();
  params.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  settings.apply(parameters, params);
  out.clear();
  return SaturationAwareRateEstimator(params).estimate(samples, out);
}

Method rate_raw() {
  return make_method({.name = "raw",
                      .kind = Kind::rate,
                      .doc = "Returns the gyro readings of the primary IMU unchanged, including clipped readings; the "
                             "variance is the noise variance of the data sheet.",
                      .source = "baseline without a method",
                      .baseline = true},
                     run_rate_raw);
}

Method rate_interpolate() {
  return make_method({.name = "interpolate",
                      .kind = Kind::rate,
                      .doc = "Interpolates each clipped segment with a cubic polynomial. The polynomial continues the "
                             "values and slopes at both ends of the segment, and stays beyond the saturation limit. "
                             "The method is designed for short segments without impact.",
                      .source = "textbook: cubic interpolation",
                      .settings = {&rate_interpolate_settings()}},
                     run_rate_interpolate);
}

Method rate_saave() {
  return make_method(
      {.name = "saave",
       .kind = Kind::rate,
       .doc = "Estimates the clipped axis from the centripetal force in free flight, then applies a smoother with "
              "white noise on jerk. docs/papers/rig.md compares the errors with those of the ICRA 2024 paper.",
       .source = "Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024",
       .settings = {&rate_saave_settings()},
       .robots = {"rig", "pendulum", "sphere"}},
      run_rate_saave);
}

Method rate_oracle() {
  return make_method({.name = "oracle",
                      .kind = Kind::rate,
                      .doc = "Gives an upper bound of the accuracy: returns the readings of the same gyro without "
                             "saturation. Noise, bias and bandwidth are unchanged.",
                      .ours = true,
                      .needs_truth = true},
                     at_sample_times<run_rate_oracle>);
}

}  // namespace tumble::scenarios
