// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/seed_chain.hpp"

namespace tumble::scenarios {

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = raw_rates(sensors, samples, estimate.rates);
  if (estimate.status.ok()) run_seed_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_icp_raw() {
  MethodInfo info;
  info.name = "icp_raw";
  info.kind = Kind::slam;
  info.doc = "The chain of seed with the gyro as it is, clipped where it clips.";
  info.source = "baseline of Deschenes et al., ICRA 2024";
  info.parameters = seed_parameters();
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
