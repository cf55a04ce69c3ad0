// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/madgwick.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Madgwick::Params>& attitude_madgwick_settings() {
  static const Settings<baselines::Madgwick::Params> all(baselines::Madgwick::Params{});
  return all;
}

Estimate run_attitude_madgwick(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<baselines::Madgwick>(sensors, attitude_madgwick_settings().read(parameters));
}

}  // namespace

Method attitude_madgwick() {
  MethodInfo info;
  info.name = "madgwick";
  info.kind = Kind::attitude;
  info.doc = "Applies Madgwick's gradient-descent filter to gyro and accelerometer of the primary IMU.";
  info.source = "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010";
  info.settings = {&attitude_madgwick_settings()};
  return make_method(std::move(info), run_attitude_madgwick);
}

}  // namespace tumble::scenarios
