// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/motion/hand.hpp"
#include "sim/motion/path.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kHandPathParameters = with_hand(std::array{
    Parameter{"rest_s", 1.5, 0.0, 30.0, "s", "rest before the path"},
    Parameter{"shape", 0.0, 0.0, kPathShapes - 1.0, "1",
              "0: line along +x; 1: L with two equal legs; 2: figure eight; 3: smooth random path"},
    Parameter{"length_m", 4.0, 0.05, 100.0, "m",
              "length of the path; the bounding box of the path is centred in the world"},
    Parameter{"heading_rad", 0.0, -3.2, 3.2, "rad", "rotation of the path about the vertical"},
    Parameter{"sway_m", 0.0, 0.0, 2.0, "m", "amplitude with which a line bends from side to side"},
    Parameter{"sway_length_m", 4.0, 0.5, 50.0, "m", "wavelength of these bends"},
    Parameter{"speed_m_s", 0.6, 0.02, 5.0, "m/s", "target speed between start and end"},
    Parameter{"acceleration_m_s2", 1.0, 0.05, 20.0, "m/s^2", "acceleration of starting and stopping"},
    Parameter{"smooth_s", 0.15, 0.01, 2.0, "s",
              "time over which the path is averaged twice; a larger value makes rounder corners"},
    Parameter{"stroke_share", 0.0, 0.0, 0.5, "1",
              "root mean square of the variation of the speed, as a share of the speed, from 0.3 to 1.5 Hz, because a "
              "hand pushes in strokes; assumed"},
    Parameter{"patch_1_push_ratio", 1.0, 0.2, 5.0, "1",
              "speed on patch 1 relative to the speed before, caused by a push through the centre; 1: no push"},
    Parameter{"patch_2_push_ratio", 1.0, 0.2, 5.0, "1", "as patch 1"},
    Parameter{"patch_3_push_ratio", 1.0, 0.2, 5.0, "1", "as patch 1"},
});

constexpr double kTick_s = 0.001;
constexpr double kPathLongest_s = 600.0;

/// Schedule contains the horizontal target position of the sphere's centre at each time step after `start_s`. The
/// sphere is at rest at the start and at the end.
class Schedule {
 public:
  Schedule(const Values& values, const engine::World& world, Stream& stream) {
    nodes_ = plan_path({static_cast<PathShape>(static_cast<int>(values.at("shape"))), values.at("length_m"),
                        values.at("heading_rad"), values.at("sway_m"), values.at("sway_length_m")},
                       stream);
    for (Eigen::Vector2d& node : nodes_) node += world.start_W_m.head<2>();
    arc_length_m_ = {0.0};
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      arc_length_m_.push_back(arc_length_m_.back() + (nodes_[i] - nodes_[i - 1]).norm());
    const int width = std::max(1, static_cast<int>(std::lround(values.at("smooth_s") / kTick_s)));
    start_s_ = values.at("rest_s");
    ticks_ = averaged(averaged(travel(values, world, stream), width), width);
  }

  const Eigen::Vector2d& first() const { return nodes_.front(); }

  void add_to(double time_s, Reference& reference) const {
    const double at = (time_s - start_s_) / kTick_s;
    const auto last = static_cast<double>(ticks_.size()) - 2.0;
    const double inside = std::clamp(at, 1.0, last);
    const auto k = static_cast<std::size_t>(std::lround(inside));
    const double u = inside - static_cast<double>(k);
    const Eigen::Vector2d slope = 0.5 * (ticks_[k + 1] - ticks_[k - 1]);
    const Eigen::Vector2d bend = ticks_[k + 1] - 2.0 * ticks_[k] + ticks_[k - 1];
    reference.p_m.head<2>() += ticks_[k] + u * slope + 0.5 * u * u * bend;
    if (at < 1.0 || at > last) return;
    reference.v_m_s.head<2>() += (slope + u * bend) / kTick_s;
    reference.a_m_s2.head<2>() += bend / (kTick_s * kTick_s);
  }

 private:
  Eigen::Vector2d point(double s_m) const {
    const auto after = std::upper_bound(arc_length_m_.begin(), arc_length_m_.end(), s_m);
    if (after == arc_length_m_.end()) return nodes_.back();
    const auto i = static_cast<std::size_t>(after - arc_length_m_.begin());
    const double u = (s_m - arc_length_m_[i - 1]) / (arc_length_m_[i] - arc_length_m_[i - 1]);
    return nodes_[i - 1] + u * (nodes_[i] - nodes_[i - 1]);
  }

  std::vector<Eigen::Vector2d> travel(const Values& values, const engine::World& world, Stream& stream) const {
    const Tremor strokes(stream, values.at("stroke_share"), 0.3, 1.5);
    const double speed_m_s = values.at("speed_m_s"), acceleration_m_s2 = values.at("acceleration_m_s2");
    std::array<double, kHandPatches> push;
    for (std::size_t i = 0; i < kHandPatches; ++i)
      push[i] = values.at("patch_" + std::to_string(i + 1) + "_push_ratio");

    std::vector<Eigen::Vector2d> ticks = {point(0.0)};
    const double length_m = arc_length_m_.back();
    double s_m = 0.0, v_m_s = 0.0;
    for (double time_s = 0.0; length_m - s_m > 1e-3; time_s += kTick_s) {
      if (time_s > kPathLongest_s)
        throw InvalidSituation(
            "motion.hand_path: the path takes longer than 600 s; shorten the path or raise the speed");
      double aim_m_s = speed_m_s * std::max(1.0 + strokes.at(time_s), 0.2);
      bool pushed = false;
      for (std::size_t i = 0; i < std::min(world.patches.size(), kHandPatches); ++i) {
        if (push[i] == 1.0 || !world.patches[i].contains(ticks.back().x(), ticks.back().y())) continue;
        aim_m_s *= push[i];
        pushed = push[i] > 1.0;
        break;
      }
      const double left_m = length_m - s_m;
      constexpr double kLastTau_s = 0.15;  // over the last centimetres
      aim_m_s = std::min({aim_m_s, std::sqrt(1.6 * acceleration_m_s2 * left_m), left_m / kLastTau_s});
      const double change = acceleration_m_s2 * kTick_s;
      v_m_s = std::clamp(aim_m_s, v_m_s - change, pushed ? aim_m_s : v_m_s + change);
      v_m_s = std::max(v_m_s, 1e-3);
      s_m += v_m_s * kTick_s;
      ticks.push_back(point(s_m));
    }
    ticks.back() = nodes_.back();
    return ticks;
  }

  static std::vector<Eigen::Vector2d> averaged(const std::vector<Eigen::Vector2d>& in, int width) {
    std::vector<Eigen::Vector2d> out;
    out.reserve(in.size() + static_cast<std::size_t>(width));
    Eigen::Vector2d sum = width * in.front();
    for (std::size_t k = 0; k < in.size() + static_cast<std::size_t>(width); ++k) {
      sum += in[std::min(k, in.size() - 1)];
      sum -= k >= static_cast<std::size_t>(width) ? in[k - static_cast<std::size_t>(width)] : in.front();
      out.push_back(sum / width);
    }
    return out;
  }

  std::vector<Eigen::Vector2d> nodes_, ticks_;
  std::vector<double> arc_length_m_;
  double start_s_ = 0.0;
};

class HandPath : public Motion {
 public:
  HandPath(const Values& values, const engine::World& world)
      : hand_("hand_path", values, world),
        height_m_(world.start_W_m.z() + hand_.radius_m()),
        schedule_(plan(values, world)) {}

  BodyState start() const override { return hand_.at_rest({schedule_.first().x(), schedule_.first().y(), height_m_}); }

  Wrench wrench(const BodyState& state) override {
    Reference reference;
    schedule_.add_to(state.time_s, reference);
    return hand_.wrench(state, reference);
  }

 private:
  static Schedule plan(const Values& values, const engine::World& world) {
    Stream stream(static_cast<std::uint64_t>(values.at("hand_seed")), "hand.path");
    return Schedule(values, world, stream);
  }

  Hand hand_;
  double height_m_;
  Schedule schedule_;
};

std::unique_ptr<Motion> make_hand_path(const Values& values, const engine::World& world) {
  return std::make_unique<HandPath>(values, world);
}

}  // namespace

const MotionType& hand_path_motion() {
  static const MotionType kType{{"hand_path",
                                 "a hand leads a sphere along a line, an L, a figure eight or a random path, and "
                                 "pushes or spins the sphere on patches",
                                 kHandPathParameters},
                                make_hand_path};
  return kType;
}

}  // namespace tumble::sim
