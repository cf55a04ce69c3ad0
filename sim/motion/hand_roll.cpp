// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/motion/hand.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kHandRollParameters = with_hand(std::array{
    Parameter{"rest_s", 1.5, 0.0, 30.0, "s", "rest before the first leg"},
    Parameter{"leg_1_m", 1.0, 0.0, 20.0, "m", "first leg, along +x"},
    Parameter{"leg_2_m", 1.0, 0.0, 20.0, "m", "length of the second leg; 0: a straight path"},
    Parameter{"turn_rad", std::numbers::pi / 2, -3.2, 3.2, "rad", "left turn between the legs"},
    Parameter{"speed_m_s", 0.6, 0.02, 5.0, "m/s",
              "maximum speed on a leg; each leg is a minimum-jerk motion from rest to rest"},
    Parameter{"pause_s", 0.3, 0.0, 30.0, "s", "duration of the stop between the legs"},
});

/// Leg is a straight path of length L with minimum jerk. The sphere is at rest at the start and at the end. At the
/// fraction u of the duration, the covered distance is L (10 u^3 - 15 u^4 + 6 u^5).
class Leg {
 public:
  Leg(const Eigen::Vector3d& along_m, double speed_m_s, double start_s)
      : along_m_(along_m), start_s_(start_s), length_s_(1.875 * along_m.norm() / speed_m_s) {}
  double end_s() const { return start_s_ + length_s_; }

  void add_to(double time_s, Reference& reference) const {
    if (length_s_ <= 0.0) return;
    const double u = std::clamp((time_s - start_s_) / length_s_, 0.0, 1.0);
    reference.p_m += along_m_ * (u * u * u * (10.0 + u * (-15.0 + 6.0 * u)));
    reference.v_m_s += along_m_ * (30.0 * u * u * (1.0 - u) * (1.0 - u) / length_s_);
    reference.a_m_s2 += along_m_ * (60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (length_s_ * length_s_));
  }

 private:
  Eigen::Vector3d along_m_;
  double start_s_, length_s_;
};

class HandRoll : public Motion {
 public:
  HandRoll(const Values& values, const engine::World& world)
      : hand_("hand_roll", values, world),
        start_G_m_(world.start_W_m + Eigen::Vector3d(0, 0, hand_.radius_m())),
        first_(values.at("leg_1_m") * Eigen::Vector3d::UnitX(), values.at("speed_m_s"), values.at("rest_s")),
        second_(second_leg(values), values.at("speed_m_s"), first_.end_s() + values.at("pause_s")) {}

  BodyState start() const override { return hand_.at_rest(start_G_m_); }

  Wrench wrench(const BodyState& state) override {
    Reference reference;
    reference.p_m = start_G_m_;
    first_.add_to(state.time_s, reference);
    second_.add_to(state.time_s, reference);
    return hand_.wrench(state, reference);
  }

 private:
  static Eigen::Vector3d second_leg(const Values& values) {
    const double turn = values.at("turn_rad");
    return values.at("leg_2_m") * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.0);
  }

  Hand hand_;
  Eigen::Vector3d start_G_m_;
  Leg first_, second_;
};

std::unique_ptr<Motion> make_hand_roll(const Values& values, const engine::World& world) {
  return std::make_unique<HandRoll>(values, world);
}

}  // namespace

const MotionType& hand_roll_motion() {
  static const MotionType kType{
      {"hand_roll", "a hand leads a sphere along two legs, from rest to rest", kHandRollParameters}, make_hand_roll};
  return kType;
}

}  // namespace tumble::sim
