// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/published_stage.hpp"
#include "scenarios/methods/rate_saave.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SaturationAwareRateEstimator::Params>& slam_published_rate_settings() {
  static const Settings<SaturationAwareRateEstimator::Params> all = other_saave_settings(published_settings().rows());
  return all;
}

Estimate run_slam_published(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    return saave_rates(sensors, samples, slam_published_rate_settings(), parameters, out.rates);
  });
  if (estimate.status.ok()) run_published_chain(sensors, samples, parameters, estimate);
  return estimate;
}

}  // namespace

Method slam_published() {
  return rig_slam(
      {.name = "published",
       .doc = "Runs the mapping method of the ICRA 2024 paper with the constants of its launch files: rates of "
              "rate/saave, Madgwick attitude, accelerometer odometry corrected by the registration, time "
              "weighting, and trimmed point-to-plane registration. Parameters switch the known faults of "
              "the method on and off. The complete map stays in memory.",
       .source = "Deschenes et al., ICRA 2024, and launch files of its authors",
       .settings = {&published_settings(), &slam_published_rate_settings()}},
      run_slam_published);
}

}  // namespace tumble::scenarios
