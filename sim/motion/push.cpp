// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "sim/motion/motion_type.hpp"
#include "sim/motion/rigid_body.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"rest_s", 1.75, 0.0, 30.0, "s", "rest before the push"},
    Parameter{"push_s", 0.2, 0.02, 2.0, "s", "length of the push; force and torque rise and fall as a raised cosine"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the robot at rest; 0: its x axis points down the slope"},
    Parameter{"direction_rad", 0.0, -3.2, 3.2, "rad", "direction of the push about z; 0: down the slope"},
    Parameter{"velocity_m_s", 2.0, 0.0, 10.0, "m/s", "impulse over mass, level"},
    Parameter{"lift_m_s", 1.0, 0.0, 10.0, "m/s", "impulse over mass, upwards"},
    Parameter{"spin_forward_rad_s", 4.0, -30.0, 30.0, "rad/s",
              "angular impulse over inertia about the axis of forward rolling"},
    Parameter{"spin_side_rad_s", 0.0, -30.0, 30.0, "rad/s", "the same about the direction of the push"},
    Parameter{"spin_up_rad_s", 0.0, -30.0, 30.0, "rad/s", "the same about the vertical"},
};

class Push : public Motion {
 public:
  Push(const Values& values, const engine::World& world) : rest_s_(values.at("rest_s")), push_s_(values.at("push_s")) {
    constexpr double kGap_m = 0.003;
    const mjModel& model = *world.model;
    start_.q_WB = Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ());
    const double height_m = clearance_m(model, world.robot_body, start_.q_WB, kGap_m);
    start_.p_WB_m = world.start_W_m + Eigen::Vector3d(0, 0, height_m);

    const double mass_kg = model.body_mass[world.robot_body];
    const double direction = values.at("direction_rad");
    const Eigen::Vector3d forward(std::cos(direction), std::sin(direction), 0.0);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    impulse_.force_W_n = mass_kg * (values.at("velocity_m_s") * forward + values.at("lift_m_s") * up);
    const Eigen::Vector3d spin_W_rad_s = values.at("spin_forward_rad_s") * up.cross(forward) +
                                         values.at("spin_side_rad_s") * forward + values.at("spin_up_rad_s") * up;
    impulse_.torque_W_nm = inertia_W_kg_m2(model, world.robot_body, start_.q_WB) * spin_W_rad_s;
  }

  BodyState start() const override { return start_; }

  Wrench wrench(const BodyState& state) override {
    const double rate_1_s = raised_cosine((state.time_s - rest_s_) / push_s_) / push_s_;
    return {impulse_.force_W_n * rate_1_s, impulse_.torque_W_nm * rate_1_s};
  }

 private:
  double rest_s_, push_s_;
  BodyState start_;
  Wrench impulse_;
};

std::unique_ptr<Motion> make(const Values& values, const engine::World& world) {
  return std::make_unique<Push>(values, world);
}

}  // namespace

const MotionType& push_motion() {
  static const MotionType kType{{"push", "at rest, then pushed by force and torque, then free", kParameters}, make};
  return kType;
}

}  // namespace tumble::sim
