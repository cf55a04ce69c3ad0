// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/complementary.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Complementary::Params>& attitude_complementary_settings() {
  static const Settings<baselines::Complementary::Params> all(baselines::Complementary::Params{});
  return all;
}

Estimate run_attitude_complementary(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<baselines::Complementary>(sensors, attitude_complementary_settings().read(parameters));
}

}  // namespace

Method attitude_complementary() {
  MethodInfo info;
  info.name = "complementary";
  info.kind = Kind::attitude;
  info.doc =
      "Integrates the gyro and corrects the tilt with the direction of the specific force, with one time constant.";
  info.source = "textbook complementary filter";
  info.settings = {&attitude_complementary_settings()};
  return make_method(std::move(info), run_attitude_complementary);
}

}  // namespace tumble::scenarios
