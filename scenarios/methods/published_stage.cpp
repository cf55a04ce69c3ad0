// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/published_stage.hpp"

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sweep_log.hpp"

namespace tumble::scenarios {

namespace {

baselines::PublishedChain::Sweep published_sweep(const bridge::Sweep& sweep) {
  return {sweep.start_ns, sweep.end_ns, sweep.points};
}

}  // namespace

const Settings<baselines::PublishedChain::Params>& published_settings() {
  static const Settings<baselines::PublishedChain::Params> all = [] {
    baselines::PublishedChain::Params params;
    params.own_body_L = presets::rig_body_L();
    return Settings<baselines::PublishedChain::Params>(params);
  }();
  return all;
}

void run_published_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                         Estimate& estimate) {
  estimate.frame = Frame::imu;
  count_sources(estimate.rates, estimate.health);
  if (sensors.lidars.empty()) {
    estimate.status = {ErrorCode::empty, "lidars", 0.0, 1.0};
    return;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  baselines::PublishedChain::Params params = published_settings().read(parameters);
  params.T_IL = bridge::T_IL(sensors.imus.front(), lidar);
  baselines::PublishedChain chain(params, samples, estimate.rates);
  const auto covers = [&](const bridge::Sweep& sweep) { return chain.covers(published_sweep(sweep)); };
  const auto add = [&](const bridge::Sweep& sweep, SweepReport& report) {
    return chain.add(published_sweep(sweep), report);
  };
  if (run_over_sweeps(lidar, {covers, add}, estimate)) estimate.map = chain.map();
}

}  // namespace tumble::scenarios
