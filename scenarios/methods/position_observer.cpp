// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/slip_observer.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::SlipObserver::Params>& position_observer_settings() {
  static const Settings<baselines::SlipObserver::Params> all(
      baselines::SlipObserver::Params{},
      {.stated = {"radius_m", "gravity_m_s2", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"}});
  return all;
}

baselines::SlipObserver::Params observer_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  baselines::SlipObserver::Params params;
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  // The lever arm refers to the centre of mass, a few millimetres from the geometric centre.
  params.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  position_observer_settings().apply(parameters, params);
  return params;
}

Estimate run_position_observer(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  SphereAttitude attitude;
  estimate.status = sphere_attitude("position/observer", sensors, rest_settings().read(parameters).rest_s, attitude);
  if (!estimate.status.ok()) return estimate;

  const baselines::SlipObserver observer(observer_params(sensors, parameters));
  baselines::SlipObserver::State state;
  estimate.poses.reserve(attitude.samples.size());
  for (std::size_t k = 0; k < attitude.samples.size(); ++k) {
    const bool before = state.open;
    estimate.status = observer.step(attitude.samples[k], attitude.q_WI[k], state);
    if (!estimate.status.ok()) return estimate;
    if (state.open && !before) estimate.health["events"] += 1.0;
    if (state.open) estimate.health["samples_in_event"] += 1.0;
    const Eigen::Vector3d p_WG_m(state.p_WG_m.x(), state.p_WG_m.y(), 0.0);
    const Eigen::Vector3d v_WG_m_s(state.v_WG_m_s.x(), state.v_WG_m_s.y(), 0.0);
    estimate.poses.push_back(centre_pose(sensors, attitude.samples[k].time_ns, attitude.q_WI[k], p_WG_m, v_WG_m_s));
    estimate.contacts.push_back(state.open ? slip_or_slide(sensors.sphere_radius_m, attitude.q_WI[k],
                                                           attitude.samples[k].angular_velocity_rad_s, v_WG_m_s)
                                           : sim::ContactLabel::grip);
  }
  return estimate;
}

}  // namespace

Method position_observer() {
  MethodInfo info;
  info.name = "observer";
  info.kind = Kind::position;
  info.doc =
      "Adds a contact velocity to the rolling velocity. During slip events, the contact velocity integrates the "
      "difference between measured and rolling acceleration.";
  info.source = "ours, only for comparison with position/tumble";
  info.settings = {&rest_settings(), &position_observer_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run_position_observer);
}

}  // namespace tumble::scenarios
