// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "scenarios/baselines/attitude/autogain.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

const std::array<sim::Parameter, 7>& parameters_of_the_filter() {
  static const baselines::Autogain::Params library;
  static const std::array<sim::Parameter, 7> parameters = {{
      {"profile", static_cast<double>(library.profile), 0.0, 2.0, "1",
       "factor by rate: 0 the paper's eq. 2, 1 the authors' code of 2021, 2 smooth"},
      {"gain_rad_s", library.gain_rad_s, 0.0, 10.0, "rad/s", "capital Theta: the Madgwick gain at full rate (eq. 4)"},
      {"tau_s", library.tau_s, 1e-3, 1e4, "s", "of the complementary step at rest (eq. 5)"},
      {"lower_rad_s", library.lower_rad_s, 0.0, 100.0, "rad/s", "rate below which the accelerometer leads (eq. 2)"},
      {"upper_rad_s", library.upper_rad_s, 1e-9, 100.0, "rad/s",
       "rate above which the gyro leads, beyond lower (eq. 2)"},
      {"roll_error_2021", library.roll_error_2021 ? 1.0 : 0.0, 0.0, 1.0, "1",
       "1: roll is never corrected, as in the authors' code of 2021"},
      {"tilt_form", library.tilt_form ? 1.0 : 0.0, 0.0, 1.0, "1",
       "1: the complementary step as the smallest rotation instead of a target in roll, pitch and yaw"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<baselines::Autogain>(sensors, autogain_params(parameters));
}

}  // namespace

std::span<const sim::Parameter> autogain_parameters() {
  return parameters_of_the_filter();
}

baselines::Autogain::Params autogain_params(const sim::Values& parameters) {
  baselines::Autogain::Params params;
  params.profile = static_cast<baselines::AutogainProfile>(std::lround(parameters.at("profile")));
  params.gain_rad_s = parameters.at("gain_rad_s");
  params.tau_s = parameters.at("tau_s");
  params.lower_rad_s = parameters.at("lower_rad_s");
  params.upper_rad_s = parameters.at("upper_rad_s");
  params.roll_error_2021 = parameters.at("roll_error_2021") >= 0.5;
  params.tilt_form = parameters.at("tilt_form") >= 0.5;
  return params;
}

Method attitude_autogain() {
  MethodInfo info;
  info.name = "autogain";
  info.kind = Kind::attitude;
  info.doc = "Madgwick step and complementary step, the rate deciding between them; made for rolling spheres.";
  info.source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-5";
  info.parameters = autogain_parameters();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
