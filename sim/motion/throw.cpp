// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/motion/held.hpp"
#include "sim/motion/impulse.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/motion/rigid_body.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnThrowParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time for which the robot is held still before the throw"},
    Parameter{"throw_s", 0.3, 0.01, 2.0, "s",
              "duration of the swing; force and torque rise and fall as a raised cosine"},
    Parameter{"height_m", 1.0, 0.1, 10.0, "m", "height of the held robot's lowest point above the ground at the start"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the held robot; 0: its x axis points down the slope"},
    Parameter{"velocity_m_s", 4.0, 0.0, 50.0, "m/s", "horizontal velocity at the release"},
    Parameter{"lift_m_s", 4.0, 0.0, 50.0, "m/s", "upward velocity at the release"},
};
constexpr std::array kThrowParameters = joined(kOwnThrowParameters, kImpulseParameters);

class Throw : public Motion {
 public:
  Throw(const Values& values, const engine::World& world)
      : hand_(world, Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond::Identity(),
              Eigen::Vector3d::Zero(), values.at("height_m")),
        rest_s_(values.at("rest_s")),
        throw_s_(values.at("throw_s")),
        impulse_(whole_impulse(values, hand_.mass_kg(), hand_.inertia_W_kg_m2())) {}

  BodyState start() const override { return hand_.start(); }

  Wrench wrench(const BodyState& state) override {
    if (state.time_s < rest_s_) return hand_.hold(state);
    const double share = (state.time_s - rest_s_) / throw_s_;
    if (share >= 1.0) return {};
    const double rate_1_s = raised_cosine(share) / throw_s_;
    return {hand_.weight_n() + impulse_.force_W_n * rate_1_s, impulse_.torque_W_nm * rate_1_s};
  }

 private:
  HoldingHand hand_;
  double rest_s_, throw_s_;
  Wrench impulse_;
};

std::unique_ptr<Motion> make_throw(const Values& values, const engine::World& world) {
  return std::make_unique<Throw>(values, world);
}

}  // namespace

const MotionType& throw_motion() {
  static const MotionType kType{
      {"throw", "a hand holds the robot above the ground, swings the robot and releases the robot", kThrowParameters},
      make_throw};
  return kType;
}

}  // namespace tumble::sim
