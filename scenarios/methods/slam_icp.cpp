// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_saave.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& slam_icp_chain_settings() {
  static const Settings<SlamParams> all = slam_settings({});
  return all;
}

const Settings<SaturationAwareRateEstimator::Params>& slam_icp_rate_settings() {
  static const Settings<SaturationAwareRateEstimator::Params> all =
      other_saave_settings(slam_icp_chain_settings().rows());
  return all;
}

Estimate run_slam_icp(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate = begin_with_rates(sensors, samples, [&](Estimate& out) {
    return saave_rates(sensors, samples, slam_icp_rate_settings(), parameters, out.rates);
  });
  if (estimate.status.ok()) run_slam_chain(sensors, samples, {slam_icp_chain_settings(), parameters}, {}, estimate);
  return estimate;
}

}  // namespace

Method slam_icp() {
  return rig_slam(
      {.name = "icp",
       .doc = "Deskews each sweep with the rates of rate/saave and registers the sweep point to plane to a voxel map.",
       .source = "based on Deschenes et al., ICRA 2024, with our own registration",
       .settings = {&slam_icp_chain_settings(), &slam_icp_rate_settings()}},
      run_slam_icp);
}

}  // namespace tumble::scenarios
