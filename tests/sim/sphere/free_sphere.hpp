// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "sim/truth/record_truth.hpp"
#include "tests/sim/engine/worlds.hpp"

namespace tumble::sim {

inline constexpr double kRadius_m = 0.145;
inline constexpr double kGravity_m_s2 = 9.80665;

/// A homogeneous sphere (with its interior in the middle) on a world, released from a given state. Returns truth as in
/// a recording.
class FreeSphere {
 public:
  explicit FreeSphere(const Situation& situation)
      : world_(engine::compose(resolve(situation), models_folder())), physics_(world_) {}

  engine::World& world() { return world_; }
  /// m r^2 / I: 1.5 for a thin shell, 2.5 for a homogeneous ball.
  double mass_ratio() const {
    const mjModel& model = *world_.model;
    return model.body_mass[world_.robot_body] * kRadius_m * kRadius_m / model.body_inertia[3 * world_.robot_body];
  }

  /// The sphere is stationary at `p_WB_m` for half a second, then has the velocity and the rate. Only gravity and
  /// contact act.
  Truth launch(const Eigen::Vector3d& p_WB_m, const Eigen::Vector3d& v_m_s, const Eigen::Vector3d& w_rad_s,
               double duration_s, bool settle = true) {
    BodyState state;
    state.p_WB_m = p_WB_m;
    physics_.set_state(state);
    for (int k = 0; settle && k < 1000; ++k) physics_.step({});
    if (settle) state = physics_.state();
    state.time_s = 0.0;
    state.v_WB_m_s = v_m_s;
    state.w_WB_B_rad_s = state.q_WB.conjugate() * w_rad_s;
    physics_.set_state(state);
    Truth truth;
    truth.period_ns = 500000;
    const int steps = static_cast<int>(duration_s / 0.0005);
    for (int k = 0; k <= steps; ++k) {
      const BodyState now = physics_.state();
      truth.p_WB_m.push_back(now.p_WB_m);
      truth.q_WB.push_back(now.q_WB);
      truth.v_WB_m_s.push_back(now.v_WB_m_s);
      truth.w_WB_B_rad_s.push_back(now.w_WB_B_rad_s);
      if (k > 0) physics_.append_contacts(k * truth.period_ns, truth.contacts);
      physics_.step({});
    }
    truth.label = label_contacts(truth);
    return truth;
  }

 private:
  engine::World world_;
  engine::Physics physics_;
};

inline Situation level_floor(double friction) {
  Situation situation = roll_along(1.0);
  situation.world.values.set("friction", friction);
  situation.world.values.set("spin_friction_m", 0.0);
  return situation;
}

/// Returns the first time after `from_s` with the label `label`; -1 if there is none.
inline double first_s(const Truth& truth, ContactLabel label, double from_s = 0.0) {
  for (std::size_t k = static_cast<std::size_t>(from_s / 0.0005); k < truth.label.size(); ++k) {
    if (truth.label[k] == label) return static_cast<double>(k) * 0.0005;
  }
  return -1.0;
}

inline std::size_t count(const Truth& truth, ContactLabel label) {
  std::size_t sum = 0;
  for (const ContactLabel one : truth.label) sum += one == label ? 1 : 0;
  return sum;
}

}  // namespace tumble::sim
