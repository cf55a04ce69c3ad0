// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/baselines/attitude/complementary.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

const std::array<sim::Parameter, 1>& parameters_of_the_filter() {
  static const baselines::Complementary::Params library;
  static const std::array<sim::Parameter, 1> parameters = {{
      {"tau_s", library.tau_s, 1e-3, 1e4, "s",
       "time in which the accelerometer takes over: 0.02 per sample at 125 Hz (Zevering et al., MFI 2021)"},
  }};
  return parameters;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  baselines::Complementary::Params params;
  params.tau_s = parameters.at("tau_s");
  return run_attitude_filter<baselines::Complementary>(sensors, params);
}

}  // namespace

Method attitude_complementary() {
  MethodInfo info;
  info.name = "complementary";
  info.kind = Kind::attitude;
  info.doc =
      "The gyro integrated, levelled towards the specific force by the smallest rotation with one time constant.";
  info.source = "textbook complementary filter";
  info.parameters = parameters_of_the_filter();
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
