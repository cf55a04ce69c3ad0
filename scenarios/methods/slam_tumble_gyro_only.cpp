// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& slam_tumble_gyro_only_settings() {
  static const Settings<SlamParams> all = slam_settings(with_calibration(with_saturation_deficit({})));
  return all;
}

Estimate run_slam_tumble_gyro_only(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate =
      begin_with_rates(sensors, samples, [&](Estimate& out) { return railed_rates(sensors, samples, out.rates); });
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, {slam_tumble_gyro_only_settings(), parameters}, {.calibration = true}, estimate);
  return estimate;
}

}  // namespace

Status railed_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out) {
  ClippingFinder::Params params;
  params.upright_rails = stated_rails(sensors.imus.front());
  const std::vector<Clipping> clipping = ClippingFinder(params).find(samples).clippings;

  if (const Status status = raw_rates(sensors, samples, out); !status.ok()) return status;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].clipped_axes = clipping[k].gyro;
    out[k].source = clipping[k].gyro ? RateSource::bounded_only : RateSource::measured;
  }
  return {};
}

Method slam_tumble_gyro_only() {
  return rig_slam({.name = "tumble_gyro_only",
                   .doc = "The chain of tumble with the clipped gyro: the saturation deficit of clipped axes comes "
                          "from the registration alone.",
                   .ours = true,
                   .settings = {&slam_tumble_gyro_only_settings()}},
                  run_slam_tumble_gyro_only);
}

}  // namespace tumble::scenarios
