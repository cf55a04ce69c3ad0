// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_rates() {
  static const std::vector<sim::Parameter> all =
      joined_parameters({slam_parameters(), excess_parameters(), calibration_parameters(), tumble_rate_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    return tumble_rates(sensors, samples, parameters, out.rates, out.health);
  });
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, parameters, {.saturation_deficit = true, .calibration = true}, estimate);
  return estimate;
}

}  // namespace

Method slam_tumble() {
  return rig_slam(
      {.name = "tumble",
       .doc =
           "The chain of icp with the rates of rate/tumble, the excess of clipped axes estimated in the registration.",
       .source = "ours",
       .parameters = parameters_with_rates()},
      run);
}

}  // namespace tumble::scenarios
