// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/published_chain.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_chain.hpp"
#include "scenarios/methods/sweep_log.hpp"

namespace tumble::scenarios {

namespace {

using SaaveSettings = Settings<SaturationAwareRateEstimator::Params>;

baselines::PublishedChain::Sweep published_sweep(const bridge::Sweep& sweep) {
  return {sweep.start_ns, sweep.end_ns, sweep.points};
}

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
  const auto add = [&](const bridge::Sweep& sweep, SweepResult& report) {
    return chain.add(published_sweep(sweep), report);
  };
  if (run_over_sweeps(lidar, {covers, add}, estimate)) estimate.map = chain.map();
}

const SaaveSettings& published_rate_settings() {
  static const SaaveSettings all = other_saave_settings(published_settings().rows());
  return all;
}

Estimate run_slam_published(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    return saave_rates(sensors, samples, published_rate_settings(), parameters, out.rates);
  });
  if (estimate.status.ok()) run_published_chain(sensors, samples, parameters, estimate);
  return estimate;
}

Estimate run_slam_icp_raw(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate =
      begin_with_rates(sensors, samples, [&](Estimate& out) { return raw_rates(sensors, samples, out.rates); });
  if (estimate.status.ok()) run_published_chain(sensors, samples, parameters, estimate);
  return estimate;
}

const Settings<SlamParams>& icp_settings() {
  static const Settings<SlamParams> all = slam_settings({});
  return all;
}

const SaaveSettings& icp_rate_settings() {
  static const SaaveSettings all = other_saave_settings(icp_settings().rows());
  return all;
}

Estimate run_slam_icp(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    return saave_rates(sensors, samples, icp_rate_settings(), parameters, out.rates);
  });
  if (estimate.status.ok()) run_slam_chain(sensors, samples, {icp_settings(), parameters}, {}, estimate);
  return estimate;
}

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

Method slam_published() {
  return make_method(
      {.name = "published",
       .kind = Kind::slam,
       .doc = "Runs the mapping method of the ICRA 2024 paper with the constants of its launch files. The rates come "
              "from rate/saave and the attitude from Madgwick's filter. Trimmed point-to-plane registration with time "
              "weighting corrects the accelerometer odometry. Parameters switch the known faults of the method on and "
              "off. The complete map stays in memory.",
       .source = "Deschenes et al., ICRA 2024, and launch files of its authors",
       .settings = {&published_settings(), &published_rate_settings()},
       .robots = {"rig"}},
      run_slam_published);
}

Method slam_icp_raw() {
  return make_method({.name = "icp_raw",
                      .kind = Kind::slam,
                      .doc = "Runs slam/published with the raw gyro readings, including clipped readings.",
                      .source = "baseline of Deschenes et al., ICRA 2024",
                      .settings = {&published_settings()},
                      .robots = {"rig"},
                      .baseline = true},
                     run_slam_icp_raw);
}

Method slam_icp() {
  return make_method({.name = "icp",
                      .kind = Kind::slam,
                      .doc = "Deskews each sweep with the rates of rate/saave and registers the sweep to a voxel map "
                             "by point-to-plane ICP.",
                      .source = "based on Deschenes et al., ICRA 2024, with our own registration",
                      .settings = {&icp_settings(), &icp_rate_settings()},
                      .robots = {"rig"}},
                     run_slam_icp);
}

Method slam_oracle() {
  return make_method({.name = "oracle",
                      .kind = Kind::slam,
                      .doc = "Gives an upper bound of the accuracy: runs slam/tumble with a gyro without saturation. "
                             "The accelerometer is unchanged.",
                      .ours = true,
                      .settings = {&slam_oracle_settings()},
                      .needs_truth = true,
                      .robots = {"rig"}},
                     at_sample_times<run_slam_oracle>);
}

}  // namespace tumble::scenarios
