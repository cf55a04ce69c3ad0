// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_saave() {
  static const std::vector<sim::Parameter> all = joined_parameters({slam_parameters(), saave_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(
      sensors, samples, [&](Estimate& out) { return saave_rates(sensors, samples, parameters, out.rates); });
  if (estimate.status.ok()) run_slam_chain(sensors, samples, parameters, {}, estimate);
  return estimate;
}

}  // namespace

Method slam_icp() {
  return rig_slam({.name = "icp",
                   .doc = "Sweeps deskewed with the rates of saave, registered point-to-plane to a voxel map.",
                   .source = "after Deschenes et al., ICRA 2024, with a registration of our own",
                   .parameters = parameters_with_saave()},
                  run);
}

}  // namespace tumble::scenarios
