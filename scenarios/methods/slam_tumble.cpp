// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_rates() {
  static const std::vector<sim::Parameter> all =
      joined_parameters({slam_parameters(), excess_parameters(), calibration_parameters(), tumble_rate_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) {
    estimate.status = tumble_rates(sensors, samples, parameters, estimate.rates, estimate.health);
  }
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, parameters, {.excess_rate = true, .calibration = true}, estimate);
  return estimate;
}

}  // namespace

Method slam_tumble() {
  MethodInfo info;
  info.name = "tumble";
  info.kind = Kind::slam;
  info.doc =
      "The chain of icp with the rates of rate/tumble, the excess of clipped axes estimated in the registration.";
  info.source = "ours";
  info.parameters = parameters_with_rates();
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
