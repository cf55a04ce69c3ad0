// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& slam_oracle_settings() {
  static const Settings<SlamParams> all = slam_settings(with_few_matches(with_calibration({})));
  return all;
}

Estimate run_slam_oracle(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(
      sensors, samples, [&](Estimate& out) { return unclipped_rates(sensors, *oracle.truth, out.rates); });
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, {slam_oracle_settings(), parameters}, {.calibration = true}, estimate);
  return estimate;
}

}  // namespace

Method slam_oracle() {
  return rig_slam({.name = "oracle",
                   .doc = "Gives an upper bound of the accuracy: runs slam/tumble with a gyro without saturation. The "
                          "accelerometer is unchanged.",
                   .ours = true,
                   .settings = {&slam_oracle_settings()},
                   .needs_truth = true},
                  at_sample_times<run_slam_oracle>);
}

}  // namespace tumble::scenarios
