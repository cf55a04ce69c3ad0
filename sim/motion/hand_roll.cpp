// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sim/motion/motion_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"rest_s", 1.5, 0.0, 30.0, "s", "rest before the first leg"},
    Parameter{"leg_1_m", 1.0, 0.0, 20.0, "m", "first leg, along +x"},
    Parameter{"leg_2_m", 1.0, 0.0, 20.0, "m", "second leg; 0: a straight way"},
    Parameter{"turn_rad", std::numbers::pi / 2, -3.2, 3.2, "rad", "turn to the left between the legs"},
    Parameter{"speed_m_s", 0.6, 0.02, 5.0, "m/s",
              "largest speed on a leg; each leg is a minimum-jerk motion from rest to rest"},
    Parameter{"pause_s", 0.3, 0.0, 30.0, "s", "stop between the legs"},
    Parameter{"stiffness_n_m", 400.0, 1.0, 5000.0, "N/m", "of the hand about its way, level; assumed"},
    Parameter{"damping_n_s_m", 90.0, 0.0, 1000.0, "N s/m", "of the hand, level; assumed"},
    Parameter{"twist_damping_nm_s", 0.03, 0.0, 10.0, "N m s", "of the hand against spin about the vertical; assumed"},
    Parameter{"torque_limit_nm", 3.0, 0.0, 50.0, "N m", "largest torque of a burst"},
    Parameter{"burst_time_s", 0.04, 0.005, 1.0, "s", "time constant with which a burst reaches its rate"},
    Parameter{"burst_s", 1.0, 0.0, 30.0, "s", "longest burst; it ends earlier where the patch ends"},
    Parameter{"patch_1_spin_ratio", 1.0, -3.0, 5.0, "1",
              "rate over the rate of pure rolling that a burst aims at on patch 1: above 1 it spins, below 1 it "
              "slides; 1: no burst"},
    Parameter{"patch_1_axis_rad", 0.0, -1.6, 1.6, "rad",
              "turn of the burst's axis about the vertical against that of rolling"},
    Parameter{"patch_2_spin_ratio", 1.0, -3.0, 5.0, "1", "as patch 1"},
    Parameter{"patch_2_axis_rad", 0.0, -1.6, 1.6, "rad", "as patch 1"},
    Parameter{"patch_3_spin_ratio", 1.0, -3.0, 5.0, "1", "as patch 1"},
    Parameter{"patch_3_axis_rad", 0.0, -1.6, 1.6, "rad", "as patch 1"},
};
constexpr int kPatches = 3;

struct Reference {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero(), v_m_s = Eigen::Vector3d::Zero(), a_m_s2 = Eigen::Vector3d::Zero();
};

/// Straight way from rest to rest of least jerk: s = L (10 u^3 - 15 u^4 + 6 u^5), peak speed 15/8 of the mean.
class Leg {
 public:
  Leg(const Eigen::Vector3d& along_m, double speed_m_s, double start_s)
      : along_m_(along_m), start_s_(start_s), length_s_(1.875 * along_m.norm() / speed_m_s) {}
  double end_s() const { return start_s_ + length_s_; }

  /// Adds the part of the way covered at `time_s`.
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
      : world_(world),
        values_(values),
        radius_m_(world.sphere_radius_m),
        p_BG_m_(-world.com_offset_m),
        start_G_m_(world.start_W_m + Eigen::Vector3d(0, 0, radius_m_)),
        first_(values.at("leg_1_m") * Eigen::Vector3d::UnitX(), values.at("speed_m_s"), values.at("rest_s")),
        second_(second_leg(values), values.at("speed_m_s"), first_.end_s() + values.at("pause_s")) {
    if (radius_m_ <= 0.0) throw InvalidSituation("motion.hand_roll: only a sphere can be rolled by hand");
    const mjModel& model = *world.model;
    mass_kg_ = model.body_mass[world.robot_body];
    inertia_kg_m2_ = Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * world.robot_body).mean();
    burst_end_s_.fill(std::numeric_limits<double>::infinity());
  }

  /// The heavy side points down, so that gravity holds the sphere at rest.
  BodyState start() const override {
    BodyState state;
    if (p_BG_m_.norm() > 1e-6) state.q_WB.setFromTwoVectors(p_BG_m_, Eigen::Vector3d::UnitZ());
    state.p_WB_m = start_G_m_ - state.q_WB * p_BG_m_;
    return state;
  }

  Wrench wrench(const BodyState& state) override {
    const Eigen::Vector3d r_BG_m = state.q_WB * p_BG_m_;
    const Eigen::Vector3d w_W = state.q_WB * state.w_WB_B_rad_s;
    const Eigen::Vector3d p_G = state.p_WB_m + r_BG_m;
    const Eigen::Vector3d v_G = state.v_WB_m_s + w_W.cross(r_BG_m);
    const Reference reference = way(state.time_s);

    Wrench out;
    // a rolling sphere resists with mass + inertia / radius^2; the rest is left to the hand's stiffness
    const double rolling_mass_kg = mass_kg_ + inertia_kg_m2_ / (radius_m_ * radius_m_);
    out.force_W_n = values_.at("stiffness_n_m") * (reference.p_m - p_G) +
                    values_.at("damping_n_s_m") * (reference.v_m_s - v_G) + rolling_mass_kg * reference.a_m_s2;
    out.force_W_n.z() = 0.0;
    out.torque_W_nm = r_BG_m.cross(out.force_W_n);
    out.torque_W_nm.z() -= values_.at("twist_damping_nm_s") * w_W.z();
    out.torque_W_nm += burst(state.time_s, p_G, reference.v_m_s, w_W);
    return out;
  }

 private:
  static Eigen::Vector3d second_leg(const Values& values) {
    const double turn = values.at("turn_rad");
    return values.at("leg_2_m") * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.0);
  }

  Reference way(double time_s) const {
    Reference reference;
    reference.p_m = start_G_m_;
    first_.add_to(time_s, reference);
    second_.add_to(time_s, reference);
    return reference;
  }

  /// Torque that drives the rate away from rolling while the sphere touches a patch.
  Eigen::Vector3d burst(double time_s, const Eigen::Vector3d& p_G_m, const Eigen::Vector3d& v_m_s,
                        const Eigen::Vector3d& w_W) {
    for (std::size_t i = 0; i < world_.patches.size() && i < kPatches; ++i) {
      const std::string name = "patch_" + std::to_string(i + 1);
      const double ratio = values_.at(name + "_spin_ratio");
      if (ratio == 1.0 || !world_.patches[i].contains(p_G_m.x(), p_G_m.y())) continue;
      if (std::isinf(burst_end_s_[i])) burst_end_s_[i] = time_s + values_.at("burst_s");
      if (time_s >= burst_end_s_[i]) continue;
      const Eigen::Vector3d rolling = Eigen::Vector3d::UnitZ().cross(v_m_s) / radius_m_;
      const Eigen::Vector3d aim =
          ratio * (Eigen::AngleAxisd(values_.at(name + "_axis_rad"), Eigen::Vector3d::UnitZ()) * rolling);
      const Eigen::Vector3d torque = inertia_kg_m2_ / values_.at("burst_time_s") * (aim - w_W);
      const double size = torque.norm(), limit = values_.at("torque_limit_nm");
      return size > limit ? Eigen::Vector3d(torque * (limit / size)) : torque;
    }
    return Eigen::Vector3d::Zero();
  }

  const engine::World& world_;
  Values values_;
  double radius_m_;
  Eigen::Vector3d p_BG_m_, start_G_m_;
  Leg first_, second_;
  double mass_kg_ = 0.0, inertia_kg_m2_ = 0.0;
  std::array<double, kPatches> burst_end_s_{};
};

std::unique_ptr<Motion> make(const Values& values, const engine::World& world) {
  return std::make_unique<HandRoll>(values, world);
}

}  // namespace

const MotionType& hand_roll_motion() {
  static const MotionType kType{{"hand_roll", "a hand leads a sphere along two legs, from rest to rest", kParameters},
                                make};
  return kType;
}

}  // namespace tumble::sim
