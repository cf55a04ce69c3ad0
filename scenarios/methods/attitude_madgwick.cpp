// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/baselines/attitude/madgwick.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

const std::array<sim::Parameter, 1>& parameters_of_the_filter() {
  static const baselines::Madgwick::Params library;
  static const std::array<sim::Parameter, 1> parameters = {{
      {"gain_rad_s", library.gain_rad_s, 0.0, 10.0, "rad/s",
       "speed of the tilt correction, as a quaternion rate (Madgwick, eq. 33)"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  baselines::Madgwick::Params params;
  params.gain_rad_s = parameters.at("gain_rad_s");
  return run_attitude_filter<baselines::Madgwick>(sensors, params);
}

}  // namespace

Method attitude_madgwick() {
  MethodInfo info;
  info.name = "madgwick";
  info.kind = Kind::attitude;
  info.doc = "Madgwick's gradient filter on the primary IMU's gyro and accelerometer.";
  info.source = "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010";
  info.parameters = parameters_of_the_filter();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
