// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"

namespace tumble::scenarios {

namespace {

Estimate run_rate_carried(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<AttitudeState> attitudes;
  estimate.status = run_carried(sensors, parameters, estimate.rates, attitudes, estimate.health);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_carried() {
  MethodInfo info;
  info.name = "carried";
  info.kind = Kind::rate;
  info.doc =
      "Smooths the whole recording of a hand-held body. The rotation of gravity in the sensor axes determines the rate "
      "of a clipped gyro.";
  info.ours = true;
  info.settings = {&carried_settings()};
  return make_method(std::move(info), at_sample_times<run_rate_carried>);
}

}  // namespace tumble::scenarios
