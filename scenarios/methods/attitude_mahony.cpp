// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/mahony.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Mahony::Params>& attitude_mahony_settings() {
  static const Settings<baselines::Mahony::Params> all(baselines::Mahony::Params{});
  return all;
}

Estimate run_attitude_mahony(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<baselines::Mahony>(sensors, attitude_mahony_settings().read(parameters));
}

}  // namespace

Method attitude_mahony() {
  MethodInfo info;
  info.name = "mahony";
  info.kind = Kind::attitude;
  info.doc =
      "Applies the explicit complementary filter on SO(3) with gyro bias to gyro and accelerometer of the primary IMU.";
  info.source = "R. Mahony, T. Hamel, J.-M. Pflimlin, Nonlinear complementary filters, IEEE TAC 53(5), 2008";
  info.settings = {&attitude_mahony_settings()};
  return make_method(std::move(info), run_attitude_mahony);
}

}  // namespace tumble::scenarios
