// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/seed_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_saave() {
  static const std::vector<sim::Parameter> all = joined_parameters({seed_parameters(), saave_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = saave_rates(sensors, samples, parameters, estimate.rates);
  if (estimate.status.ok()) run_seed_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_seed() {
  MethodInfo info;
  info.name = "seed";
  info.kind = Kind::slam;
  info.doc =
      "The published chain with the constants as launched: rates of saave, Madgwick's attitude, accelerometer "
      "odometry fed back by the registration, time weighting, trimmed point to plane; its errors are parameters. Map "
      "in memory whole.";
  info.source = "Deschenes et al., ICRA 2024, and the authors' launch files";
  info.parameters = parameters_with_saave();
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
