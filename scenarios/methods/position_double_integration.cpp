// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/double_integration.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::DoubleIntegration::Params>& position_double_integration_settings() {
  static const Settings<baselines::DoubleIntegration::Params> all(baselines::DoubleIntegration::Params{},
                                                                  {.stated = {"gravity_m_s2"}});
  return all;
}

Estimate run_position_double_integration(const sim::Sensors& sensors, const sim::Values& parameters,
                                         const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  SphereAttitude attitude;
  estimate.status =
      sphere_attitude("position/double_integration", sensors, rest_settings().read(parameters).rest_s, attitude);
  if (!estimate.status.ok()) return estimate;

  baselines::DoubleIntegration::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  position_double_integration_settings().apply(parameters, params);
  const baselines::DoubleIntegration integration(params);
  baselines::DoubleIntegration::State state;
  const Eigen::Vector3d arm_I_m = bridge::lever_arm_I_m(sensors.imus.front());
  const Eigen::Vector3d start_W_m = attitude.q_WI.front() * arm_I_m;
  estimate.poses.reserve(attitude.samples.size());
  for (std::size_t k = 0; k < attitude.samples.size(); ++k) {
    const ImuSample& sample = attitude.samples[k];
    const Eigen::Quaterniond& q_WI = attitude.q_WI[k];
    estimate.status = integration.step(sample, q_WI, state);
    if (!estimate.status.ok()) return estimate;
    const Eigen::Vector3d arm_W_m = q_WI * arm_I_m;
    const Eigen::Vector3d w_W_rad_s = q_WI * sample.angular_velocity_rad_s;
    estimate.poses.push_back(centre_pose(sensors, sample.time_ns, q_WI, start_W_m + state.p_WI_m - arm_W_m,
                                         state.v_WI_m_s - w_W_rad_s.cross(arm_W_m)));
  }
  return estimate;
}

}  // namespace

Method position_double_integration() {
  MethodInfo info;
  info.name = "double_integration";
  info.kind = Kind::position;
  info.doc =
      "Integrates the accelerometer twice, with the attitude of the integrated gyro; the position drifts without "
      "bound.";
  info.source = "textbook strapdown inertial navigation";
  info.settings = {&rest_settings(), &position_double_integration_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run_position_double_integration);
}

}  // namespace tumble::scenarios
