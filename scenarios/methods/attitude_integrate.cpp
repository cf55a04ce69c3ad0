// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/strapdown.hpp"

namespace tumble::scenarios {

namespace {

const Settings<Strapdown::Params>& attitude_integrate_settings() {
  static const Settings<Strapdown::Params> all(Strapdown::Params{});
  return all;
}

Estimate run_attitude_integrate(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<Strapdown>(sensors, attitude_integrate_settings().read(parameters));
}

}  // namespace

Method attitude_integrate() {
  MethodInfo info;
  info.name = "integrate";
  info.kind = Kind::attitude;
  info.doc = "Integrates the gyro of the primary IMU; the first accelerometer reading gives the initial tilt.";
  info.source = "textbook strapdown integration";
  info.settings = {&attitude_integrate_settings()};
  return make_method(std::move(info), run_attitude_integrate);
}

}  // namespace tumble::scenarios
