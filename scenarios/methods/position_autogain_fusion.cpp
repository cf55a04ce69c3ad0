// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/baselines/rolling/autogain_fusion.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

sim::Parameter a_switch(const char* name, bool by_default, const char* doc) {
  return {name, by_default ? 1.0 : 0.0, 0.0, 1.0, "1", doc};
}

const std::array<sim::Parameter, 9>& parameters_of_the_fusion() {
  static const baselines::AutogainFusion::Params library;
  static const std::array<sim::Parameter, 9> parameters = {{
      {"limiter", library.limiter, 0.0, 100.0, "1",
       "integrated over rolling velocity, at most; 1.1 in the authors' code"},
      {"rotation_weight", library.rotation_weight, 0.0, 10.0, "1", "of the rolling velocity (eq. 13)"},
      {"acceleration_weight", library.acceleration_weight, 0.0, 10.0, "1", "of the integrated acceleration (eq. 13)"},
      a_switch("integrate_in_body", library.integrate_in_body, "1: eq. 7 in the turning frame, as printed; 0: in W"),
      a_switch("direction_only", library.direction_only, "1: the force as a unit vector, as in the authors' code"),
      a_switch("recursive_coupling", library.recursive_coupling, "1: eq. 8 scales the integral itself, as in the code"),
      a_switch("limit_per_axis", library.limit_per_axis, "1: limits along the world's axes; 0: the horizontal vector"),
      a_switch("shrink_per_axis", library.shrink_per_axis, "1: eq. 12 takes v_z^2 from each axis, as printed; 0: once"),
      a_switch("vertical_by_norm", library.vertical_by_norm, "1: vertical speed limited by the norm, as in the code"),
  }};
  return parameters;
}

std::span<const sim::Parameter> parameters_with_attitude() {
  static const std::vector<sim::Parameter> all = joined_parameters({autogain_parameters(), parameters_of_the_fusion()});
  return all;
}

baselines::AutogainFusion::Params fusion_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  baselines::AutogainFusion::Params params;
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.autogain = autogain_params(parameters);
  params.limiter = parameters.at("limiter");
  params.rotation_weight = parameters.at("rotation_weight");
  params.acceleration_weight = parameters.at("acceleration_weight");
  params.integrate_in_body = parameters.at("integrate_in_body") >= 0.5;
  params.direction_only = parameters.at("direction_only") >= 0.5;
  params.recursive_coupling = parameters.at("recursive_coupling") >= 0.5;
  params.limit_per_axis = parameters.at("limit_per_axis") >= 0.5;
  params.shrink_per_axis = parameters.at("shrink_per_axis") >= 0.5;
  params.vertical_by_norm = parameters.at("vertical_by_norm") >= 0.5;
  return params;
}

// as published, the attitude is the autogain filter's, of the readings as they are
Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
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
  info.doc = "Rolling averaged with the limited integral of the acceleration, on the attitude of autogain.";
  info.source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-13";
  info.parameters = parameters_with_attitude();
  info.robots = {"sphere"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
