// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/motion/impulse.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/motion/rigid_body.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnPushParameters = {
    Parameter{"rest_s", 1.75, 0.0, 30.0, "s", "rest before the push"},
    Parameter{"push_s", 0.2, 0.02, 2.0, "s", "duration of the push; force and torque rise and fall as a raised cosine"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the robot at rest; 0: its x axis points down the slope"},
    Parameter{"velocity_m_s", 2.0, 0.0, 10.0, "m/s",
              "change of the horizontal velocity, caused by the push (impulse over mass)"},
    Parameter{"lift_m_s", 1.0, 0.0, 10.0, "m/s",
              "change of the upward velocity, caused by the push (impulse over mass)"},
};
constexpr std::array kPushParameters = joined(kOwnPushParameters, kImpulseParameters);

class Push : public Motion {
 public:
  Push(const Values& values, const engine::World& world) : rest_s_(values.at("rest_s")), push_s_(values.at("push_s")) {
    constexpr double kGap_m = 0.003;
    const mjModel& model = *world.model;
    start_.q_WB = Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ());
    const double height_m = clearance_m(model, world.robot_body, start_.q_WB, kGap_m);
    start_.p_WB_m = world.start_W_m + Eigen::Vector3d(0, 0, height_m);

    impulse_ =
        whole_impulse(values, model.body_mass[world.robot_body], inertia_W_kg_m2(model, world.robot_body, start_.q_WB));
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

std::unique_ptr<Motion> make_push(const Values& values, const engine::World& world) {
  return std::make_unique<Push>(values, world);
}

}  // namespace

const MotionType& push_motion() {
  static const MotionType kType{
      {"push", "the robot rests, a force and a torque push the robot, and then the robot moves freely",
       kPushParameters},
      make_push};
  return kType;
}

}  // namespace tumble::sim
