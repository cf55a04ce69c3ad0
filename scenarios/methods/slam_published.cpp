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
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(
      sensors, samples, [&](Estimate& out) { return saave_rates(sensors, samples, parameters, out.rates); });
  if (estimate.status.ok()) run_seed_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_published() {
  return rig_slam(
      {.name = "published",
       .doc = "The published chain with the constants as launched: rates of saave, Madgwick's attitude, accelerometer "
              "odometry fed back by the registration, time weighting, trimmed point to plane; its errors are "
              "parameters. Map in memory whole.",
       .source = "Deschenes et al., ICRA 2024, and the authors' launch files",
       .parameters = parameters_with_saave()},
      run);
}

}  // namespace tumble::scenarios
