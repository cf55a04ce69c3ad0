// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/published_stage.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"

namespace tumble::scenarios {

namespace {

Estimate run_slam_icp_raw(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate =
      begin_with_rates(sensors, samples, [&](Estimate& out) { return raw_rates(sensors, samples, out.rates); });
  if (estimate.status.ok()) run_published_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_icp_raw() {
  return rig_slam({.name = "icp_raw",
                   .doc = "Runs slam/icp with the unchanged readings of the clipped gyro.",
                   .source = "baseline of Deschenes et al., ICRA 2024",
                   .settings = {&published_settings()},
                   .baseline = true},
                  run_slam_icp_raw);
}

}  // namespace tumble::scenarios
