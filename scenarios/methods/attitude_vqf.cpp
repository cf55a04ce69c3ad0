// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/vqf.hpp"

namespace tumble::scenarios {

namespace {

// the library's defaults are the authors'
const Settings<Vqf::Params>& settings() {
  static const Settings<Vqf::Params> all{Vqf::Params{}};
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<Vqf>(sensors, settings().read(parameters));
}

}  // namespace

Method attitude_vqf() {
  MethodInfo info;
  info.name = "vqf";
  info.kind = Kind::attitude;
  info.doc = "Specific force low-passed in a nearly inertial frame, gyro bias at rest and in motion; no magnetometer.";
  info.source = "D. Laidig, T. Seel, VQF, Information Fusion 91, 2023";
  info.settings = {&settings()};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
