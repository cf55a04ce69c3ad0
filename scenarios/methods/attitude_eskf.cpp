// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <numbers>

#include "scenarios/baselines/attitude/eskf.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

const std::array<sim::Parameter, 5>& parameters_of_the_filter() {
  static const baselines::Eskf::Params library;
  static const std::array<sim::Parameter, 5> parameters = {{
      {"gyro_noise_rad_sqrts", library.gyro_noise_rad_sqrts, 1e-12, 1.0, "rad/sqrt(s)", "angle random walk"},
      {"bias_walk_rad_s_sqrts", library.bias_walk_rad_s_sqrts, 0.0, 1.0, "rad/s/sqrt(s)",
       "random walk of the gyro's bias"},
      {"bias_sigma_start_rad_s", library.bias_sigma_start_rad_s, 0.0, 1.0, "rad/s", "prior of the gyro's bias"},
      {"tilt_sigma_start_rad", library.tilt_sigma_start_rad, 1e-12, std::numbers::pi, "rad",
       "error of the levelling by the first sample"},
      {"acceleration_noise_m_s2_sqrts", library.acceleration_noise_m_s2_sqrts, 1e-12, 100.0, "m/s^2 sqrt(s)",
       "the body's acceleration as white noise: sigma of its mean over 1 s"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  baselines::Eskf::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.gyro_noise_rad_sqrts = parameters.at("gyro_noise_rad_sqrts");
  params.bias_walk_rad_s_sqrts = parameters.at("bias_walk_rad_s_sqrts");
  params.bias_sigma_start_rad_s = parameters.at("bias_sigma_start_rad_s");
  params.tilt_sigma_start_rad = parameters.at("tilt_sigma_start_rad");
  params.acceleration_noise_m_s2_sqrts = parameters.at("acceleration_noise_m_s2_sqrts");
  // the filter's error is that of AttitudeState: world axes, q_true = Exp(phi) q
  return run_attitude_filter<baselines::Eskf>(
      sensors, params,
      [](const baselines::Eskf::State& state) -> Eigen::Matrix3d { return state.covariance.topLeftCorner<3, 3>(); });
}

}  // namespace

Method attitude_eskf() {
  MethodInfo info;
  info.name = "eskf";
  info.kind = Kind::attitude;
  info.doc = "Error-state Kalman filter of attitude and gyro bias with the specific force as a measurement of up.";
  info.source = "textbook, J. Sola, Quaternion kinematics for the error-state Kalman filter, arXiv 1711.02508";
  info.parameters = parameters_of_the_filter();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
