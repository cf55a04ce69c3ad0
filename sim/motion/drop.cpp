// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/motion/held.hpp"
#include "sim/motion/motion_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kDropParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time for which the hand holds the robot before the release"},
    Parameter{"release_s", 0.15, 0.0, 1.0, "s", "duration of the release, during which the hand's force fades out"},
    Parameter{"height_m", 1.0, 0.1, 20.0, "m", "height of the held robot's lowest point above the ground at the start"},
    Parameter{"forward_m", 0.0, -5.0, 10.0, "m", "distance of the held robot from the start, down the slope"},
    Parameter{"roll_rad", 0.0, -3.2, 3.2, "rad", "attitude of the held robot: rotation about the robot's x axis, then"},
    Parameter{"pitch_rad", 0.0, -1.6, 1.6, "rad", "about y, then"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "about z"},
};

Eigen::Quaterniond attitude(const Values& values) {
  return Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(values.at("pitch_rad"), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(values.at("roll_rad"), Eigen::Vector3d::UnitX());
}

class Drop : public Motion {
 public:
  Drop(const Values& values, const engine::World& world)
      : hand_(world, attitude(values), {values.at("forward_m"), 0.0, 0.0}, values.at("height_m")),
        rest_s_(values.at("rest_s")),
        release_s_(values.at("release_s")) {}

  BodyState start() const override { return hand_.start(); }

  Wrench wrench(const BodyState& state) override {
    if (state.time_s < rest_s_) return hand_.hold(state);
    const double into_s = state.time_s - rest_s_;
    if (into_s >= release_s_) return {};
    return {hand_.weight_n() * (1.0 - into_s / release_s_), Eigen::Vector3d::Zero()};
  }

 private:
  HoldingHand hand_;
  double rest_s_, release_s_;
};

std::unique_ptr<Motion> make_drop(const Values& values, const engine::World& world) {
  return std::make_unique<Drop>(values, world);
}

}  // namespace

const MotionType& drop_motion() {
  static const MotionType kType{
      {"drop", "a hand holds the robot above the ground and releases the robot", kDropParameters}, make_drop};
  return kType;
}

}  // namespace tumble::sim
