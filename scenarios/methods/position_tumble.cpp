// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <memory>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sphere_attitude.hpp"
#include "tumble/rolling/rolling_filter.hpp"

namespace tumble::scenarios {

namespace {

// the library's own defaults, so that each stands in one place; sources are those of the library's documentation
const std::array<sim::Parameter, 10>& parameters_of_the_filter() {
  static const RollingFilter::Params library;
  static const std::array<sim::Parameter, 10> parameters = {{
      {"tilt_sigma_rad", library.tilt_sigma_rad, 0.0, 1e3, "rad", "prior of the levelling by the first sample"},
      {"gyro_bias_sigma_rad_s", library.gyro_bias_sigma_rad_s, 0.0, 1e3, "rad/s", "prior of the gyro's bias"},
      {"accel_bias_sigma_m_s2", library.accel_bias_sigma_m_s2, 0.0, 1e3, "m/s^2", "prior of the accelerometer's bias"},
      {"lever_arm_sigma_m", library.lever_arm_sigma_m, 0.0, 1e3, "m",
       "prior of the lever arm from the sphere's centre"},
      {"grip_sigma_m_s", library.grip_sigma_m_s, 1e-12, 1e3, "m/s", "of the contact velocity while gripping"},
      {"slip_begins_per_s", library.slip_begins_per_s, 1e-12, 1e3, "1/s", "rate of grip changing to slip"},
      {"slip_ends_per_s", library.slip_ends_per_s, 1e-12, 1e3, "1/s", "and back"},
      {"bump_begins_per_s", library.bump_begins_per_s, 1e-12, 1e3, "1/s", "rate of grip changing to bump"},
      {"bump_ends_per_s", library.bump_ends_per_s, 1e-12, 1e3, "1/s", "and back"},
      {"event_shortest_s", library.event_shortest_s, 0.0, 10.0, "s", "least stay in slip or bump"},
  }};
  return parameters;
}

RollingFilter::Params filter_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  RollingFilter::Params params;
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  // from the centre of mass, which the calibration refers to; what lies between it and the centre is estimated
  params.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  params.tilt_sigma_rad = parameters.at("tilt_sigma_rad");
  params.gyro_bias_sigma_rad_s = parameters.at("gyro_bias_sigma_rad_s");
  params.accel_bias_sigma_m_s2 = parameters.at("accel_bias_sigma_m_s2");
  params.lever_arm_sigma_m = parameters.at("lever_arm_sigma_m");
  params.grip_sigma_m_s = parameters.at("grip_sigma_m_s");
  params.slip_begins_per_s = parameters.at("slip_begins_per_s");
  params.slip_ends_per_s = parameters.at("slip_ends_per_s");
  params.bump_begins_per_s = parameters.at("bump_begins_per_s");
  params.bump_ends_per_s = parameters.at("bump_ends_per_s");
  params.event_shortest_s = parameters.at("event_shortest_s");
  return params;
}

sim::ContactLabel contact_label(double radius_m, const ImuSample& sample, const RollingFilter::State& state) {
  switch (state.mode) {
    case RollingMode::grip:
      return sim::ContactLabel::grip;
    case RollingMode::slip:
      return slip_or_slide(radius_m, state.q_WI, sample.angular_velocity_rad_s, state.v_WG_m_s);
    case RollingMode::bump:
      break;
  }
  return sim::ContactLabel::air;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  require_sphere("position/tumble", sensors);

  const RollingFilter filter(filter_params(sensors, parameters));
  // 360 KiB: not for the stack of a worker
  const auto state = std::make_unique<RollingFilter::State>();
  estimate.poses.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = filter.step(sample, *state);
    if (!estimate.status.ok()) return estimate;
    PoseState pose = centre_pose(sensors, sample.time_ns, state->q_WI, state->p_WG_m, state->v_WG_m_s);
    pose.covariance.topLeftCorner<3, 3>() = state->position_covariance_m2;
    estimate.poses.push_back(pose);
    estimate.contacts.push_back(contact_label(sensors.sphere_radius_m, sample, *state));
    if (state->mode == RollingMode::slip) estimate.health["samples_slip"] += 1.0;
    if (state->mode == RollingMode::bump) estimate.health["samples_bump"] += 1.0;
    if (state->at_rest) estimate.health["samples_rest"] += 1.0;
  }
  return estimate;
}

}  // namespace

Method position_tumble() {
  MethodInfo info;
  info.name = "tumble";
  info.kind = Kind::position;
  info.doc = "Rolling as a velocity measurement in an inertial filter, with grip, slip and bump as hypotheses; live.";
  info.source = "ours";
  info.parameters = parameters_of_the_filter();
  info.robots = {"sphere"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
