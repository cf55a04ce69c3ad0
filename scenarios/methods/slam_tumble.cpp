// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& slam_tumble_chain_settings() {
  static const Settings<SlamParams> all =
      slam_settings(with_few_matches(with_calibration(with_saturation_deficit({}))));
  return all;
}

const Settings<RateSmoother::Params>& slam_tumble_rate_settings() {
  static const Settings<RateSmoother::Params> all(
      RateSmoother::Params{},
      {.stated = stated_densities(), .beside = slam_tumble_chain_settings().rows(), .prefix = "rate_"});
  return all;
}

Estimate run_slam_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& input) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    const RateSmoother::Params params = smoother_params(sensors.imus.front(), slam_tumble_rate_settings(), parameters);
    SmoothedRates smoothed;
    const Status status = tumble_rates(sensors, samples, params, smoothed, out);
    out.rates = std::move(smoothed.rates);
    if (status.ok() && !check_rates(sensors, samples, smoothed.carried.share, out)) inflate_rates(out);
    return status;
  });
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, {slam_tumble_chain_settings(), parameters},
                   {.calibration = true, .on_sweep = input.on_sweep}, estimate);
  return estimate;
}

}  // namespace

Method slam_tumble() {
  return rig_slam({.name = "tumble",
                   .doc = "The chain of icp with the rates of rate/tumble; the registration estimates the saturation "
                          "deficit of clipped axes.",
                   .ours = true,
                   .settings = {&slam_tumble_chain_settings(), &slam_tumble_rate_settings()}},
                  at_sample_times<run_slam_tumble>);
}

}  // namespace tumble::scenarios
