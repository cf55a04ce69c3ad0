// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/rolling_odometry.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::RollingOdometry::Params>& position_rolling_settings() {
  static const Settings<baselines::RollingOdometry::Params> all(baselines::RollingOdometry::Params{},
                                                                {.stated = {"radius_m"}});
  return all;
}

Estimate run_position_rolling(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  SphereAttitude attitude;
  estimate.status = sphere_attitude("position/rolling", sensors, rest_settings().read(parameters).rest_s, attitude);
  if (!estimate.status.ok()) return estimate;

  baselines::RollingOdometry::Params params;
  params.radius_m = sensors.sphere_radius_m;
  position_rolling_settings().apply(parameters, params);
  const baselines::RollingOdometry odometry(params);
  baselines::RollingOdometry::State state;
  estimate.poses.reserve(attitude.samples.size());
  for (std::size_t k = 0; k < attitude.samples.size(); ++k) {
    const ImuSample& sample = attitude.samples[k];
    estimate.status = odometry.step(sample.time_ns, sample.angular_velocity_rad_s, attitude.q_WI[k], state);
    if (!estimate.status.ok()) return estimate;
    estimate.poses.push_back(centre_pose(sensors, sample.time_ns, attitude.q_WI[k], state.p_WG_m, state.v_WG_m_s));
  }
  return estimate;
}

}  // namespace

Method position_rolling() {
  MethodInfo info;
  info.name = "rolling";
  info.kind = Kind::position;
  info.doc =
      "Assumes rolling without slip on a level plane: removes the gyro bias at rest, integrates the gyro, and computes "
      "the velocity as v = r w x n.";
  info.source = "textbook rolling constraint";
  info.settings = {&rest_settings(), &position_rolling_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run_position_rolling);
}

}  // namespace tumble::scenarios
