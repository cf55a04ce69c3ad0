// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "sim/motion/held.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/motion/rigid_body.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kLaunchParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time for which the robot is held still before the launch"},
    Parameter{"height_m", 1.0, 0.1, 5000.0, "m", "height of the robot's lowest point above the ground at the start"},
    Parameter{"elevation_rad", 1.4, -1.6, 1.6, "rad", "angle of the robot's x axis above the horizon at the start"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the robot's x axis at the start"},
    Parameter{"thrust_m_s2", 0.0, 0.0, 200.0, "m/s^2", "thrust along the long axis, divided by the mass"},
    Parameter{"burn_s", 0.0, 0.0, 20.0, "s", "time from the launch to the end of the thrust"},
    Parameter{"drag_1_m", 0.01, 0.0, 1.0, "1/m", "deceleration by air drag, divided by the squared airspeed"},
    Parameter{"fins_1_m2", 0.05, 0.0, 10.0, "1/m^2",
              "angular acceleration by which the fins turn the long axis into the direction of flight, divided by the "
              "squared airspeed and by the sine of the angle of attack"},
    Parameter{"fins_damping_1_m", 0.02, 0.0, 10.0, "1/m",
              "rate at which the air damps the rotation across the long axis, divided by the airspeed"},
    Parameter{"roll_rad_m", 0.0, -20.0, 20.0, "rad/m",
              "rate about the long axis at which the canted fins cause no torque, divided by the airspeed"},
    Parameter{"roll_damping_1_m", 0.02, 0.0, 10.0, "1/m",
              "rate at which the rate about the long axis approaches that rate, divided by the airspeed"},
    Parameter{"parachute_s", 0.0, 0.0, 100.0, "s", "time from the launch to the parachute; 0: no parachute"},
    Parameter{"parachute_drag_1_m", 0.2, 0.0, 2.0, "1/m",
              "deceleration by the parachute, divided by the squared airspeed of its attachment"},
    Parameter{"parachute_arm_m", -0.3, -2.0, 2.0, "m",
              "position of the parachute's attachment on the long axis, relative to the centre of mass"},
};

/// Launch holds the robot above the ground and releases the robot. Then thrust, air drag, canted fins and a parachute
/// act on the robot. The long axis of the robot is its first principal axis of inertia.
class Launch : public Motion {
 public:
  Launch(const Values& values, const engine::World& world)
      : hand_(world,
              Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(-values.at("elevation_rad"), Eigen::Vector3d::UnitY()),
              Eigen::Vector3d::Zero(), values.at("height_m")),
        values_(values),
        model_(*world.model),
        body_(world.robot_body) {
    const mjtNum* q = model_.body_iquat + 4 * body_;
    long_axis_B_ = Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitX();
  }

  BodyState start() const override { return hand_.start(); }

  Wrench wrench(const BodyState& state) override {
    const double flying_s = state.time_s - values_.at("rest_s");
    if (flying_s < 0.0) return hand_.hold(state);
    Wrench out;
    out.force_W_n =
        hand_.mass_kg() * (thrust_W_m_s2(state, flying_s) + drag_W_m_s2(values_.at("drag_1_m"), state.v_WB_m_s));
    out.torque_W_nm = inertia_W_kg_m2(model_, body_, state.q_WB) * fins_W_rad_s2(state);
    add_parachute(state, flying_s, out);
    return out;
  }

 private:
  static constexpr double kIgnition_s = 0.05, kInflation_s = 0.3;

  static Eigen::Vector3d drag_W_m_s2(double drag_1_m, const Eigen::Vector3d& v_m_s) {
    return -drag_1_m * v_m_s.norm() * v_m_s;
  }

  Eigen::Vector3d thrust_W_m_s2(const BodyState& state, double flying_s) const {
    const double burnt_s = values_.at("burn_s") - flying_s;
    const double share = std::clamp(std::min(flying_s, burnt_s) / kIgnition_s, 0.0, 1.0);
    return share * values_.at("thrust_m_s2") * (state.q_WB * long_axis_B_);
  }

  Eigen::Vector3d fins_W_rad_s2(const BodyState& state) const {
    const Eigen::Vector3d axis_W = state.q_WB * long_axis_B_, w_W = state.q_WB * state.w_WB_B_rad_s;
    const double speed_m_s = state.v_WB_m_s.norm(), roll_rad_s = axis_W.dot(w_W);
    return values_.at("fins_1_m2") * speed_m_s * axis_W.cross(state.v_WB_m_s) -
           values_.at("fins_damping_1_m") * speed_m_s * (w_W - roll_rad_s * axis_W) +
           values_.at("roll_damping_1_m") * speed_m_s * (values_.at("roll_rad_m") * speed_m_s - roll_rad_s) * axis_W;
  }

  void add_parachute(const BodyState& state, double flying_s, Wrench& out) const {
    const double opened_s = flying_s - values_.at("parachute_s");
    if (values_.at("parachute_s") <= 0.0 || opened_s <= 0.0) return;
    const Eigen::Vector3d arm_W_m = values_.at("parachute_arm_m") * (state.q_WB * long_axis_B_);
    const Eigen::Vector3d v_W_m_s = state.v_WB_m_s + (state.q_WB * state.w_WB_B_rad_s).cross(arm_W_m);
    const double open = std::min(1.0, opened_s / kInflation_s);
    const Eigen::Vector3d force_W_n =
        hand_.mass_kg() * drag_W_m_s2(open * open * values_.at("parachute_drag_1_m"), v_W_m_s);
    out.force_W_n += force_W_n;
    out.torque_W_nm += arm_W_m.cross(force_W_n);
  }

  HoldingHand hand_;
  Values values_;
  const mjModel& model_;
  int body_;
  Eigen::Vector3d long_axis_B_;
};

std::unique_ptr<Motion> make_launch(const Values& values, const engine::World& world) {
  return std::make_unique<Launch>(values, world);
}

}  // namespace

const MotionType& launch_motion() {
  static const MotionType kType{
      {"launch", "the robot is held, released, and flies with thrust, air drag, canted fins and a parachute",
       kLaunchParameters},
      make_launch};
  return kType;
}

}  // namespace tumble::sim
