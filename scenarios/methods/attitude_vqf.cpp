// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble::scenarios {

namespace {

// The defaults are the authors' values.
const Settings<Vqf::Params>& attitude_vqf_settings() {
  static const Settings<Vqf::Params> all{Vqf::Params{}};
  return all;
}

Estimate run_attitude_vqf(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<Vqf>(sensors, attitude_vqf_settings().read(parameters));
}

}  // namespace

Method attitude_vqf() {
  MethodInfo info;
  info.name = "vqf";
  info.kind = Kind::attitude;
  info.doc =
      "Low-passes the specific force in a nearly inertial frame and estimates the gyro bias at rest and in motion, "
      "without a magnetometer.";
  info.source = "D. Laidig, T. Seel, VQF, Information Fusion 91, 2023";
  info.settings = {&attitude_vqf_settings()};
  return make_method(std::move(info), run_attitude_vqf);
}

}  // namespace tumble::scenarios
