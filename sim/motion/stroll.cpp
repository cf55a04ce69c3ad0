// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/motion/carrying.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/motion/tremor.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kStrollParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time for which the robot is held still before the first step"},
    Parameter{"height_m", 1.0, 0.1, 10.0, "m", "height of the held robot's lowest point above the ground at the start"},
    Parameter{"heading_rad", 0.0, -3.2, 3.2, "rad", "rotation of the whole path about the vertical"},
    Parameter{"half_length_m", 2.4, 0.2, 20.0, "m",
              "half length a of the figure eight x = a sin u, y = b sin 2u; the path starts at the crossing"},
    Parameter{"half_width_m", 1.2, 0.1, 20.0, "m", "half width b of the figure eight"},
    Parameter{"loops", 1.0, 0.1, 100.0, "1", "number of rounds of the figure eight"},
    Parameter{"speed_m_s", 1.2, 0.05, 3.0, "m/s", "speed at the crossing, which is the maximum speed"},
    Parameter{
        "ease_s", 1.5, 0.2, 10.0, "s",
        "time in which the walker reaches the speed at the crossing, and time in which the walker stops at the end"},
    Parameter{"step_hz", 1.8, 0.2, 4.0, "Hz", "steps per second of the walker; assumed"},
    Parameter{"step_m", 0.015, 0.0, 0.1, "m", "amplitude with which the steps lift the robot; assumed"},
    Parameter{"sway_rad", 0.08, 0.0, 0.5, "rad",
              "root mean square of the robot's roll, pitch and yaw, from 0.2 to 1.2 Hz; assumed"},
    Parameter{"sway_m", 0.02, 0.0, 0.2, "m", "root mean square of the position's tremor, per axis; assumed"},
    Parameter{"hand_seed", 0.0, 0.0, 1e9, "1", "seed of the hand's random behaviour; the number is rounded down"},
};

constexpr double kSwayLow_hz = 0.2, kSwayHigh_hz = 1.2;

/// Stroll moves the robot like a walker who carries the robot along a horizontal figure of eight, from rest to rest.
class Stroll : public Motion {
 public:
  Stroll(const Values& values, const engine::World& world)
      : values_(values),
        half_length_m_(values.at("half_length_m")),
        half_width_m_(values.at("half_width_m")),
        phase_rate_rad_s_(values.at("speed_m_s") / std::hypot(half_length_m_, 2.0 * half_width_m_)),
        ease_s_(values.at("ease_s")),
        walk_s_(std::max(2.0 * std::numbers::pi * values.at("loops") / phase_rate_rad_s_, ease_s_) + ease_s_),
        hand_(world, heading(0.0), Eigen::Vector3d::Zero(), values.at("height_m")),
        inertia_B_kg_m2_(carried_inertia_B_kg_m2(hand_)) {
    Stream stream(static_cast<std::uint64_t>(values.at("hand_seed")), "hand.stroll");
    for (int i = 0; i < 3; ++i) rotations_.emplace_back(stream, values.at("sway_rad"), kSwayLow_hz, kSwayHigh_hz);
    for (int i = 0; i < 3; ++i) positions_.emplace_back(stream, values.at("sway_m"), kSwayLow_hz, kSwayHigh_hz);
  }

  BodyState start() const override { return hand_.start(); }

  Wrench wrench(const BodyState& state) override {
    return carry_along(hand_, inertia_B_kg_m2_, state, [this](double time_s) { return path(time_s); });
  }

 private:
  double phase_rad(double walked_s) const {
    const auto begun_s = [this](double t_s) {  // integral of `eased`
      const double u = std::clamp(t_s / ease_s_, 0.0, 1.0);
      return ease_s_ * u * u * u * u * (2.5 + u * (-3.0 + u));
    };
    const double t_s = std::clamp(walked_s, 0.0, walk_s_);
    if (t_s < ease_s_) return phase_rate_rad_s_ * begun_s(t_s);
    if (t_s < walk_s_ - ease_s_) return phase_rate_rad_s_ * (t_s - 0.5 * ease_s_);
    return phase_rate_rad_s_ * (walk_s_ - ease_s_ - begun_s(walk_s_ - t_s));
  }

  Eigen::Quaterniond heading(double phase_rad) const {
    const double yaw_rad =
        std::atan2(2.0 * half_width_m_ * std::cos(2.0 * phase_rad), half_length_m_ * std::cos(phase_rad));
    return Eigen::Quaterniond(Eigen::AngleAxisd(values_.at("heading_rad") + yaw_rad, Eigen::Vector3d::UnitZ()));
  }

  HandHeldPose path(double time_s) const {
    const double walked_s = time_s - values_.at("rest_s"), phase = phase_rad(walked_s);
    const double share = eased(walked_s) * eased(walk_s_ - walked_s);
    const double step_rad = 2.0 * std::numbers::pi * values_.at("step_hz") * walked_s;
    const Eigen::Vector3d eight_m(half_length_m_ * std::sin(phase), half_width_m_ * std::sin(2.0 * phase),
                                  share * values_.at("step_m") * std::sin(step_rad));
    const Eigen::Vector3d sway_m(positions_[0].at(time_s), positions_[1].at(time_s), positions_[2].at(time_s));
    return {hand_.start().p_WB_m + Eigen::AngleAxisd(values_.at("heading_rad"), Eigen::Vector3d::UnitZ()) * eight_m +
                share * sway_m,
            heading(phase) * Eigen::AngleAxisd(share * rotations_[0].at(time_s), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(share * rotations_[1].at(time_s), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(share * rotations_[2].at(time_s), Eigen::Vector3d::UnitX())};
  }

  Values values_;
  double half_length_m_, half_width_m_, phase_rate_rad_s_, ease_s_, walk_s_;
  HoldingHand hand_;
  Eigen::Matrix3d inertia_B_kg_m2_;
  std::vector<Tremor> rotations_, positions_;  ///< z, y, x; and x, y, z
};

std::unique_ptr<Motion> make_stroll(const Values& values, const engine::World& world) {
  return std::make_unique<Stroll>(values, world);
}

}  // namespace

const MotionType& stroll_motion() {
  static const MotionType kType{
      {"stroll", "a walker carries the robot along a horizontal figure eight, from rest to rest", kStrollParameters},
      make_stroll};
  return kType;
}

}  // namespace tumble::sim
