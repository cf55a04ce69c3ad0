// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = unclipped_rates(sensors, *oracle.truth, estimate.rates);
  if (estimate.status.ok()) run_slam_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_oracle() {
  MethodInfo info;
  info.name = "oracle";
  info.kind = Kind::slam;
  info.doc = "The chain of icp with the gyro's unclipped twin; the accelerometer stays as read. The bound.";
  info.source = "ours";
  info.parameters = slam_parameters();
  info.needs_truth = true;
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
