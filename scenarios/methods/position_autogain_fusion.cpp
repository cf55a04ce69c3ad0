// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/autogain_fusion.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Autogain::Params>& attitude_settings() {
  static const Settings<baselines::Autogain::Params> all(baselines::Autogain::Params{});
  return all;
}

const Settings<baselines::AutogainFusion::Params>& fusion_settings() {
  static const Settings<baselines::AutogainFusion::Params> all(baselines::AutogainFusion::Params{},
                                                               {.stated = {"radius_m", "gravity_m_s2"},
                                                                .fixed = {"autogain_*"},
                                                                .beside = attitude_settings().rows(),
                                                                .prefix = "fusion_"});
  return all;
}

baselines::AutogainFusion::Params fusion_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  baselines::AutogainFusion::Params params;
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  fusion_settings().apply(parameters, params);
  params.autogain = attitude_settings().read(parameters);
  return params;
}

Estimate run_position_autogain_fusion(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  require_sphere("position/autogain_fusion", sensors);

  const baselines::AutogainFusion::Params params = fusion_params(sensors, parameters);
  const baselines::Autogain autogain(params.autogain);
  const baselines::AutogainFusion fusion(params);
  baselines::Autogain::State attitude;
  baselines::AutogainFusion::State state;
  estimate.poses.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = autogain.step(sample, attitude);
    if (estimate.status.ok()) estimate.status = fusion.step(sample, attitude.q_WI, state);
    if (!estimate.status.ok()) return estimate;
    estimate.poses.push_back(centre_pose(sensors, sample.time_ns, attitude.q_WI, state.p_WG_m, state.v_WG_m_s));
  }
  return estimate;
}

}  // namespace

Method position_autogain_fusion() {
  MethodInfo info;
  info.name = "autogain_fusion";
  info.kind = Kind::position;
  info.doc =
      "Averages the rolling velocity and a limited integral of the acceleration, and uses the attitude of "
      "attitude/autogain.";
  info.source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-13";
  info.settings = {&attitude_settings(), &fusion_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run_position_autogain_fusion);
}

}  // namespace tumble::scenarios
