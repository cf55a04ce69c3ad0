// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_calibration() {
  static const std::vector<sim::Parameter> all = joined_parameters({slam_parameters(), calibration_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = unclipped_rates(sensors, *oracle.truth, estimate.rates);
  if (estimate.status.ok()) run_slam_chain(sensors, samples, parameters, {.calibration = true}, estimate);
  return estimate;
}

}  // namespace

Method slam_oracle() {
  MethodInfo info;
  info.name = "oracle";
  info.kind = Kind::slam;
  info.doc = "The chain of tumble with the gyro's unclipped twin; the accelerometer stays as read. The bound.";
  info.source = "ours";
  info.parameters = parameters_with_calibration();
  info.needs_truth = true;
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
