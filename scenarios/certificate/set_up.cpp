// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/set_up.hpp"

#include <cmath>

#include "sim/imu/imu_parameters.hpp"

namespace tumble::scenarios {

sim::Situation bare_room(const std::string& robot) {
  sim::Situation situation;
  situation.scenario = "certificate";
  situation.seed = 1;
  situation.world.type = "floor";
  situation.world.values.set("pillar_count", 0.0);
  situation.world.values.set("box_count", 0.0);
  situation.robot.type = robot;
  situation.motion.type = robot == "sphere" ? "hand_roll" : robot == "pendulum" ? "swing" : "push";
  return situation;
}

sim::BuiltSituation build(const CertificateInput& input, const sim::Situation& situation) {
  return {sim::resolve(situation), input.data.models()};
}

sim::BodyState thrown(double rate_rad_s) {
  sim::BodyState state;
  state.p_WB_m = {0.0, 0.0, 100.0};
  state.v_WB_m_s = {0.5, -0.3, 20.0};
  // The rig's z axis has the intermediate moment of inertia, so small rates about x and y make the rig tumble within
  // five seconds.
  state.w_WB_B_rad_s = Eigen::Vector3d(0.3, 0.2, 18.0) * (rate_rad_s / 18.0);
  return state;
}

sim::Truth fly(sim::Trial& trial, double duration_s) {
  sim::Truth truth;
  truth.period_ns = std::llround(trial.step_s() * 1e9);
  const auto append = [&](const sim::BodyState& state) {
    truth.p_WB_m.push_back(state.p_WB_m);
    truth.q_WB.push_back(state.q_WB);
    truth.v_WB_m_s.push_back(state.v_WB_m_s);
    truth.w_WB_B_rad_s.push_back(state.w_WB_B_rad_s);
  };
  append(trial.state());
  const std::int64_t steps = std::llround(duration_s / trial.step_s());
  for (std::int64_t k = 0; k < steps; ++k) {
    trial.step();
    append(trial.state());
  }
  return truth;
}

sim::SensorSpec imu_of_sheet(const DataSheet& sheet) {
  sim::SensorSpec sensor;
  sensor.name = sheet.device;
  sensor.kind = sheet.sensor_kind;
  sensor.device = sheet.device;
  sensor.values = sim::resolve(sheet.device, sheet.values(), sim::imu_parameters());
  return sensor;
}

double larger(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}

}  // namespace tumble::scenarios
