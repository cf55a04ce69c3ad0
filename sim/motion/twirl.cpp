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

constexpr std::array kTwirlParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time for which the robot is held still before the first stroke"},
    Parameter{"height_m", 1.0, 0.1, 10.0, "m", "height of the held robot's lowest point above the ground at the start"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the held robot"},
    Parameter{"spin_rad_s", 10.5, 0.0, 40.0, "rad/s", "mean peak rate of the strokes about the robot's x axis"},
    Parameter{"spin_spread_rad_s", 2.0, 0.0, 20.0, "rad/s",
              "standard deviation of the peak rates, truncated at 2.5 sigma"},
    Parameter{"stroke_s", 0.9, 0.1, 5.0, "s", "duration of a stroke; the rate rises during the first third"},
    Parameter{"interval_s", 1.65, 0.1, 20.0, "s",
              "mean time between strokes, varied by up to a quarter; a stroke starts only after the previous stroke "
              "has ended"},
    Parameter{"turn_back_share", 0.45, 0.0, 1.0, "1",
              "share of the strokes that rotate against the direction of the previous stroke"},
    Parameter{"twist_rad", 0.4, 0.0, 3.0, "rad",
              "root mean square of the tremor about x in addition to the strokes, from 0.3 to 4 Hz; measured on the "
              "real wand"},
    Parameter{"sway_rad", 0.03, 0.0, 0.5, "rad",
              "root mean square of the tremor in pitch and yaw, from 0.3 to 4 Hz; assumed"},
    Parameter{"sway_m", 0.01, 0.0, 0.2, "m",
              "root mean square of the tremor of the grip's position, per axis; assumed"},
    Parameter{"grip_x_m", 0.0, -0.5, 0.5, "m",
              "point of the robot that the hand holds, in the robot's design frame, body axes"},
    Parameter{"grip_y_m", 0.0, -0.5, 0.5, "m", "the same along y"},
    Parameter{"grip_z_m", 0.0, -0.5, 0.5, "m", "the same along z"},
    Parameter{"hand_seed", 0.0, 0.0, 1e9, "1", "seed of the hand's random behaviour; the number is rounded down"},
};

constexpr double kTwirlSwayLow_hz = 0.3, kTwirlSwayHigh_hz = 4.0;
constexpr double kTwirlLongest_s = 120.0;

struct Stroke {
  static constexpr double kRise = 1.0 / 3.0;
  double start_s, length_s, peak_rad_s;

  double angle_rad(double time_s) const {
    constexpr double kFall = 1.0 - kRise;
    const double u = std::clamp((time_s - start_s) / length_s, 0.0, 1.0);
    const double rise = std::min(u, kRise), fall = std::max(u - kRise, 0.0);
    return peak_rad_s * length_s *
           (0.5 * rise - kRise / (2.0 * std::numbers::pi) * std::sin(std::numbers::pi * rise / kRise) + 0.5 * fall +
            kFall / (2.0 * std::numbers::pi) * std::sin(std::numbers::pi * fall / kFall));
  }
};

std::vector<Stroke> plan_strokes(const Values& values, Stream& stream) {
  std::vector<Stroke> strokes;
  const double length_s = values.at("stroke_s"), interval_s = values.at("interval_s");
  double sign = stream.uniform() < 0.5 ? 1.0 : -1.0;
  for (double start_s = values.at("rest_s") + 0.5; start_s < kTwirlLongest_s;) {
    const double off = std::clamp(stream.normal(), -2.5, 2.5);
    strokes.push_back({start_s, length_s, sign * (values.at("spin_rad_s") + off * values.at("spin_spread_rad_s"))});
    start_s += std::max(length_s, interval_s * stream.uniform(0.75, 1.25));
    if (stream.uniform() < values.at("turn_back_share")) sign = -sign;
  }
  return strokes;
}

/// In the motion Twirl, a hand holds the robot at one point and rotates the robot about the x axis, stroke by stroke.
class Twirl : public Motion {
 public:
  Twirl(const Values& values, const engine::World& world)
      : hand_(world, Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond::Identity(),
              Eigen::Vector3d::Zero(), values.at("height_m")),
        rest_s_(values.at("rest_s")),
        grip_B_m_(Eigen::Vector3d(values.at("grip_x_m"), values.at("grip_y_m"), values.at("grip_z_m")) -
                  world.com_offset_m),
        inertia_B_kg_m2_(carried_inertia_B_kg_m2(hand_)) {
    Stream stream(static_cast<std::uint64_t>(values.at("hand_seed")), "hand.twirl");
    strokes_ = plan_strokes(values, stream);
    rotations_.emplace_back(stream, values.at("twist_rad"), kTwirlSwayLow_hz, kTwirlSwayHigh_hz);
    for (int i = 0; i < 2; ++i)
      rotations_.emplace_back(stream, values.at("sway_rad"), kTwirlSwayLow_hz, kTwirlSwayHigh_hz);
    for (int i = 0; i < 3; ++i)
      positions_.emplace_back(stream, values.at("sway_m"), kTwirlSwayLow_hz, kTwirlSwayHigh_hz);
  }

  BodyState start() const override { return hand_.start(); }

  Wrench wrench(const BodyState& state) override {
    return carry_along(hand_, inertia_B_kg_m2_, state, [this](double time_s) { return path(time_s); });
  }

 private:
  HandHeldPose path(double time_s) const {
    double spun_rad = 0.0;
    for (const Stroke& stroke : strokes_) {
      if (time_s <= stroke.start_s) break;
      spun_rad += stroke.angle_rad(time_s);
    }
    const double share = eased(time_s - rest_s_);
    const Eigen::Vector3d sway_m(positions_[0].at(time_s), positions_[1].at(time_s), positions_[2].at(time_s));
    const BodyState start = hand_.start();
    HandHeldPose pose;
    pose.q = start.q_WB * Eigen::AngleAxisd(share * rotations_[1].at(time_s), Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(share * rotations_[2].at(time_s), Eigen::Vector3d::UnitY()) *
             Eigen::AngleAxisd(spun_rad + share * rotations_[0].at(time_s), Eigen::Vector3d::UnitX());
    pose.p_m = start.p_WB_m + start.q_WB * grip_B_m_ + share * sway_m - pose.q * grip_B_m_;
    return pose;
  }

  HoldingHand hand_;
  double rest_s_;
  Eigen::Vector3d grip_B_m_;
  Eigen::Matrix3d inertia_B_kg_m2_;
  std::vector<Stroke> strokes_;
  std::vector<Tremor> rotations_, positions_;  ///< x, z, y; and x, y, z
};

std::unique_ptr<Motion> make_twirl(const Values& values, const engine::World& world) {
  return std::make_unique<Twirl>(values, world);
}

}  // namespace

const MotionType& twirl_motion() {
  static const MotionType kType{
      {"twirl", "a hand carries the robot and twirls the robot about its x axis in strokes", kTwirlParameters},
      make_twirl};
  return kType;
}

}  // namespace tumble::sim
