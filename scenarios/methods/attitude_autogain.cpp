// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/autogain.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Autogain::Params>& attitude_autogain_settings() {
  static const Settings<baselines::Autogain::Params> all(baselines::Autogain::Params{});
  return all;
}

Estimate run_attitude_autogain(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<baselines::Autogain>(sensors, attitude_autogain_settings().read(parameters));
}

}  // namespace

Method attitude_autogain() {
  MethodInfo info;
  info.name = "autogain";
  info.kind = Kind::attitude;
  info.doc =
      "Combines a step of Madgwick's filter and a step of a complementary filter; the angular rate determines the "
      "weights. The filter is made for rolling spheres.";
  info.source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-5";
  info.settings = {&attitude_autogain_settings()};
  return make_method(std::move(info), run_attitude_autogain);
}

}  // namespace tumble::scenarios
