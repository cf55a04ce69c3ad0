// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/baselines/attitude/mahony.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

const std::array<sim::Parameter, 2>& parameters_of_the_filter() {
  static const baselines::Mahony::Params library;
  static const std::array<sim::Parameter, 2> parameters = {{
      {"proportional_rad_s", library.proportional_rad_s, 0.0, 100.0, "rad/s", "gain kp on the tilt error (eq. 32)"},
      {"integral_rad_s2", library.integral_rad_s2, 0.0, 100.0, "rad/s^2", "gain ki: takes up the gyro's bias (eq. 32)"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  baselines::Mahony::Params params;
  params.proportional_rad_s = parameters.at("proportional_rad_s");
  params.integral_rad_s2 = parameters.at("integral_rad_s2");
  return run_attitude_filter<baselines::Mahony>(sensors, params);
}

}  // namespace

Method attitude_mahony() {
  MethodInfo info;
  info.name = "mahony";
  info.kind = Kind::attitude;
  info.doc = "The explicit complementary filter on SO(3) with a gyro bias, gyro and accelerometer of the primary IMU.";
  info.source = "R. Mahony, T. Hamel, J.-M. Pflimlin, Nonlinear complementary filters, IEEE TAC 53(5), 2008";
  info.parameters = parameters_of_the_filter();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
