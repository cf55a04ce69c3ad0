// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/madgwick.hpp"

namespace tumble::scenarios {

namespace {

const Settings<Madgwick::Params>& settings() {
  static const Settings<Madgwick::Params> all(Madgwick::Params{});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<Madgwick>(sensors, settings().read(parameters));
}

}  // namespace

Method attitude_madgwick() {
  MethodInfo info;
  info.name = "madgwick";
  info.kind = Kind::attitude;
  info.doc = "Madgwick's gradient filter on the primary IMU's gyro and accelerometer.";
  info.source = "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010";
  info.settings = {&settings()};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
