// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/attitude/vqf.hpp"

namespace tumble::scenarios {

namespace {

// bounds and defaults are the library's, whose defaults are the authors'
const std::array<sim::Parameter, 9>& parameters_of_the_filter() {
  static const Vqf::Params library;
  static const std::array<sim::Parameter, 9> parameters = {{
      {"tau_s", library.tau_s, 1e-3, 1e4, "s", "of the low-pass on the specific force in the inertial frame"},
      {"rest_bias_estimation", library.rest_bias_estimation ? 1.0 : 0.0, 0.0, 1.0, "1", "1: gyro bias from rest"},
      {"motion_bias_estimation", library.motion_bias_estimation ? 1.0 : 0.0, 0.0, 1.0, "1", "1: and in motion"},
      {"bias_sigma_start_rad_s", library.bias_sigma_start_rad_s, 1e-12, 1.0, "rad/s", "prior of the gyro's bias"},
      {"bias_forgetting_s", library.bias_forgetting_s, 1e-12, 1e6, "s",
       "the bias' variance grows to (0.1 deg/s)^2 in it"},
      {"bias_clip_rad_s", library.bias_clip_rad_s, 1e-12, 1.0, "rad/s", "largest bias that is believed"},
      {"rest_time_s", library.rest_time_s, 0.0, 1e4, "s", "quiet for so long is rest"},
      {"rest_rate_rad_s", library.rest_rate_rad_s, 1e-12, 1.0, "rad/s", "quiet: from the low-passed gyro"},
      {"rest_force_m_s2", library.rest_force_m_s2, 1e-12, 100.0, "m/s^2", "quiet: from the low-passed force"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Vqf::Params params;
  params.tau_s = parameters.at("tau_s");
  params.rest_bias_estimation = parameters.at("rest_bias_estimation") >= 0.5;
  params.motion_bias_estimation = parameters.at("motion_bias_estimation") >= 0.5;
  params.bias_sigma_start_rad_s = parameters.at("bias_sigma_start_rad_s");
  params.bias_forgetting_s = parameters.at("bias_forgetting_s");
  params.bias_clip_rad_s = parameters.at("bias_clip_rad_s");
  params.rest_time_s = parameters.at("rest_time_s");
  params.rest_rate_rad_s = parameters.at("rest_rate_rad_s");
  params.rest_force_m_s2 = parameters.at("rest_force_m_s2");
  return run_attitude_filter<Vqf>(sensors, params);
}

}  // namespace

Method attitude_vqf() {
  MethodInfo info;
  info.name = "vqf";
  info.kind = Kind::attitude;
  info.doc = "Specific force low-passed in a nearly inertial frame, gyro bias at rest and in motion; no magnetometer.";
  info.source = "D. Laidig, T. Seel, VQF, Information Fusion 91, 2023";
  info.parameters = parameters_of_the_filter();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
