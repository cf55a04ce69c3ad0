// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_saave() {
  static const std::vector<sim::Parameter> all = joined_parameters({slam_parameters(), saave_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = saave_rates(sensors, samples, parameters, estimate.rates);
  if (estimate.status.ok()) run_slam_chain(sensors, samples, parameters, {}, estimate);
  return estimate;
}

}  // namespace

Method slam_icp() {
  MethodInfo info;
  info.name = "icp";
  info.kind = Kind::slam;
  info.doc = "Sweeps deskewed with the rates of saave, registered point-to-plane to a voxel map.";
  info.source = "after Deschenes et al., ICRA 2024, with a registration of our own";
  info.parameters = parameters_with_saave();
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
