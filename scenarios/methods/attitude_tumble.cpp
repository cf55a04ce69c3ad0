// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/attitude/tumble_attitude.hpp"

namespace tumble::scenarios {

namespace {

// the library's own defaults, so that each stands in one place; sources are those of the library's documentation
const std::array<sim::Parameter, 9>& parameters_of_the_filter() {
  static const TumbleAttitude::Params library;
  static const std::array<sim::Parameter, 9> parameters = {{
      {"gyro_noise_rad_sqrts", library.gyro_noise_rad_sqrts, 1e-12, 1.0, "rad/sqrt(s)",
       "angle random walk, unmodelled errors included"},
      {"rate_error_sqrts", library.rate_error_sqrts, 0.0, 1.0, "sqrt(s)",
       "angle random walk per rad/s turned: scale, timing"},
      {"bias_sigma_start_rad_s", library.bias_sigma_start_rad_s, 0.0, 1.0, "rad/s", "prior of the gyro's bias"},
      {"velocity_m_sqrts", library.velocity_m_sqrts, 1e-12, 1e3, "m/sqrt(s)",
       "sigma of the mean velocity over 1 s of motion"},
      {"displacement_m_sqrts", library.displacement_m_sqrts, 1e-12, 1e3, "m sqrt(s)",
       "sigma of the mean displacement over 1 s"},
      {"displacement_tau_s", library.displacement_tau_s, 0.1, 1e4, "s", "in which a displacement is forgotten"},
      {"rest_time_s", library.rest_time_s, 0.0, 1e4, "s", "quiet for so long is rest"},
      {"rest_rate_rad_s", library.rest_rate_rad_s, 1e-12, 1.0, "rad/s", "quiet: about the low-passed rate"},
      {"rest_force_m_s2", library.rest_force_m_s2, 1e-12, 100.0, "m/s^2", "quiet: about the low-passed force"},
  }};
  return parameters;
}

/// All IMUs as one, in body axes, and rolling as what the velocity is.
Estimate run_sphere(const sim::Sensors& sensors, TumbleAttitude::Params params) {
  Estimate estimate;
  estimate.frame = Frame::body;
  MergedImus imus;
  estimate.status = merge_imus(sensors, imus);
  if (!estimate.status.ok()) return estimate;
  (void)check_imus(sensors, imus, estimate);
  for (const MergedImus::LeftOut& unit : imus.out) estimate.health[to_string(unit)] = unit.since_s;
  params.radius_m = sensors.sphere_radius_m;
  params.lever_arm_m = imus.lever_arm_m;
  const TumbleAttitude filter(params);
  TumbleAttitude::State state;
  estimate.attitudes.reserve(imus.samples.size());
  for (const ImuSample& sample : imus.samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
    if (state.slipping) estimate.health["samples_slip"] += 1.0;
  }
  return estimate;
}

/// Puts what a smoother of the rate says in place of readings that the rail made wrong, all three axes of them: while
/// one clips, a tilted rail spoils those beside it too. The gyro's bias stays in, the filter takes it off. Where no
/// reading clips, or the smoother has no answer, the samples stay as they are.
void recover_clipped(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                     std::map<std::string, double>& health) {
  std::vector<ClipSigns> signs;
  (void)find_clipped(sensors.imus.front(), samples, signs);
  const auto clips = [](const ClipSigns& sign) { return sign.gyro != std::array<std::int8_t, 3>{}; };
  if (std::none_of(signs.begin(), signs.end(), clips)) return;
  const sim::Values parameters = sim::resolve("rate/tumble", {}, tumble_rate_parameters());
  std::vector<RateState> rates;
  std::map<std::string, double> of_rates;
  if (!tumble_rates(sensors, samples, parameters, rates, of_rates).ok()) return;
  double free = 0.0, recovered = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  // the smoother's rates are without
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rates[k].clipped_axes != 0) continue;
    free += 1.0;
    bias += (samples[k].angular_velocity_rad_s - rates[k].w_WI_I_rad_s - bias) / free;
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rates[k].clipped_axes == 0) continue;
    samples[k].angular_velocity_rad_s = rates[k].w_WI_I_rad_s + bias;
    recovered += 1.0;
  }
  health["samples_recovered"] = recovered;
}

/// The primary IMU, in its axes.
Estimate run_rig(const sim::Sensors& sensors, const TumbleAttitude::Params& params) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  (void)check_imu(sensors, samples, estimate);  // a warning: a body that is pushed about all the time may look so
  recover_clipped(sensors, samples, estimate.health);
  const TumbleAttitude filter(params);
  TumbleAttitude::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    // the filter's covariance is that of the tilt alone, at its last node: no covariance of a whole attitude to report
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
  }
  return estimate;
}

}  // namespace

std::span<const sim::Parameter> attitude_tumble_parameters() {
  return parameters_of_the_filter();
}

Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters) {
  TumbleAttitude::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.gyro_noise_rad_sqrts = parameters.at("gyro_noise_rad_sqrts");
  params.rate_error_sqrts = parameters.at("rate_error_sqrts");
  params.bias_sigma_start_rad_s = parameters.at("bias_sigma_start_rad_s");
  params.velocity_m_sqrts = parameters.at("velocity_m_sqrts");
  params.displacement_m_sqrts = parameters.at("displacement_m_sqrts");
  params.displacement_tau_s = parameters.at("displacement_tau_s");
  params.rest_time_s = parameters.at("rest_time_s");
  params.rest_rate_rad_s = parameters.at("rest_rate_rad_s");
  params.rest_force_m_s2 = parameters.at("rest_force_m_s2");
  return sensors.sphere_radius_m > 0.0 ? run_sphere(sensors, params) : run_rig(sensors, params);
}

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_tumble(sensors, parameters);
}

}  // namespace

Method attitude_tumble() {
  MethodInfo info;
  info.name = "tumble";
  info.kind = Kind::attitude;
  info.doc =
      "Tilt and gyro bias from the velocity being bounded, that of rolling on a sphere, and zero at rest; rates that a "
      "rail hid are those of rate/tumble.";
  info.source = "ours";
  info.parameters = attitude_tumble_parameters();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
