// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/engine/jointed.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kSwingParameters = {
    Parameter{"rest_s", 1.75, 0.5, 30.0, "s", "time before the hand grips the robot"},
    Parameter{"lift_s", 1.0, 0.2, 10.0, "s", "time in which the hand moves the lowest segment aside and up"},
    Parameter{"hold_s", 0.5, 0.0, 10.0, "s", "time for which the hand holds the lifted segment"},
    Parameter{"release_s", 0.03, 0.005, 1.0, "s", "time in which the hand releases the segment"},
    Parameter{"interval_s", 19.0, 2.0, 120.0, "s",
              "mean time between two releases, varied by up to a tenth; must be at least lift_s plus hold_s"},
    Parameter{"aside_m", 0.4, 0.0, 3.0, "m",
              "mean distance by which the segment is moved aside, perpendicular to the hinges"},
    Parameter{"up_m", 0.45, 0.0, 3.0, "m", "mean distance up"},
    Parameter{"spread_m", 0.05, 0.0, 0.5, "m",
              "standard deviation of both distances between swings, truncated at 2 sigma"},
    Parameter{"sideways_m", 0.02, 0.0, 0.5, "m",
              "standard deviation of the distance along the hinges, truncated at 2 sigma"},
    Parameter{"other_side_share", 0.3, 0.0, 1.0, "1", "share of the swings that start on the other side"},
    Parameter{"hand_seed", 0.0, 0.0, 1e9, "1", "seed of the hand's random behaviour; the number is rounded down"},
};

constexpr double kSwingLongest_s = 3600.0;

struct Lift {
  double start_s;
  Eigen::Vector3d lift_W_m;
};

double bounded(Stream& stream, double sigma) {
  return sigma * std::clamp(stream.normal(), -2.0, 2.0);
}

std::vector<Lift> plan_lifts(const Values& values, Stream& stream) {
  const double shortest_s = values.at("lift_s") + values.at("hold_s") + values.at("release_s");
  const double spread_m = values.at("spread_m");
  std::vector<Lift> lifts;
  for (double start_s = values.at("rest_s"); start_s < kSwingLongest_s;) {
    const double side = stream.uniform() < values.at("other_side_share") ? -1.0 : 1.0;
    const double aside_m = std::max(0.0, values.at("aside_m") + bounded(stream, spread_m));
    const double up_m = std::max(0.0, values.at("up_m") + bounded(stream, spread_m));
    lifts.push_back({start_s, {side * aside_m, bounded(stream, values.at("sideways_m")), up_m}});
    start_s += std::max(shortest_s, values.at("interval_s") * stream.uniform(0.9, 1.1));
  }
  return lifts;
}

double smooth(double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

/// In the motion Swing, a hand grips the lowest segment of the pendulum at the segment's centre of mass. A spring and a
/// damper pull the segment to a moving target.
class Swing : public Motion {
 public:
  Swing(const Values& values, const engine::World& world)
      : lift_s_(values.at("lift_s")),
        hold_s_(values.at("hold_s")),
        release_s_(values.at("release_s")),
        mass_kg_(world.model->body_subtreemass[world.model->body_rootid[world.robot_body]]) {
    if (world.free)
      throw InvalidSituation("motion.swing: the robot is not attached by joints; choose the robot 'pendulum'");
    start_ = engine::state_at_rest(world);
    Stream stream(static_cast<std::uint64_t>(values.at("hand_seed")), "hand.swing");
    lifts_ = plan_lifts(values, stream);
  }

  BodyState start() const override { return start_; }

  Wrench wrench(const BodyState& state) override {
    const auto after = std::upper_bound(lifts_.begin(), lifts_.end(), state.time_s,
                                        [](double time_s, const Lift& lift) { return time_s < lift.start_s; });
    if (after == lifts_.begin()) return {};
    const Lift& lift = *std::prev(after);
    const double since_s = state.time_s - lift.start_s;
    constexpr double kGrip_s = 0.3;  // time in which the fingers close
    // natural frequency of the hand's spring with the mass of the pendulum, typical of an arm
    constexpr double kFrequency_rad_s = 15.0;
    const double grip = smooth(since_s / kGrip_s) * (1.0 - smooth((since_s - lift_s_ - hold_s_) / release_s_));
    if (grip <= 0.0) return {};

    const Eigen::Vector3d aim_m = start_.p_WB_m + smooth(since_s / lift_s_) * lift.lift_W_m;
    constexpr double kStep_s = 1e-3;
    const double pace_1_s =
        (smooth((since_s + kStep_s) / lift_s_) - smooth((since_s - kStep_s) / lift_s_)) / (2.0 * kStep_s);
    const double stiffness_n_m = mass_kg_ * kFrequency_rad_s * kFrequency_rad_s;
    const double damping_n_s_m = 2.0 * mass_kg_ * kFrequency_rad_s;
    Wrench out;
    out.force_W_n =
        grip * (stiffness_n_m * (aim_m - state.p_WB_m) + damping_n_s_m * (pace_1_s * lift.lift_W_m - state.v_WB_m_s));
    return out;
  }

 private:
  double lift_s_, hold_s_, release_s_;
  double mass_kg_;
  BodyState start_;
  std::vector<Lift> lifts_;
};

std::unique_ptr<Motion> make_swing(const Values& values, const engine::World& world) {
  return std::make_unique<Swing>(values, world);
}

}  // namespace

const MotionType& swing_motion() {
  static const MotionType kType{
      {"swing", "a hand repeatedly moves a hanging robot aside and releases the robot", kSwingParameters}, make_swing};
  return kType;
}

}  // namespace tumble::sim
