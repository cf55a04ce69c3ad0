// SPDX-License-Identifier: BSD-3-Clause
#include "sim/truth/record_truth.hpp"

#include <algorithm>
#include <cmath>

#include "sim/engine/physics.hpp"
#include "sim/simulate.hpp"

namespace tumble::sim {

namespace {

constexpr double kSettle_s = 1.0;
constexpr double kRestSpeed_m_s = 0.005;
constexpr double kLeastDistance_m = 0.05;

/// Lets the robot come to rest before the recording starts; an artificial drag damps the motion.
void settle(engine::Physics& physics, const mjModel& model, int body, Motion& motion) {
  BodyState start = motion.start();
  start.time_s = -kSettle_s;
  physics.set_state(start);
  const double mass_kg = model.body_mass[body];
  const double inertia_kg_m2 = Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * body).mean();
  const int steps = static_cast<int>(std::lround(kSettle_s / physics.step_s()));
  for (int k = 0; k < steps; ++k) {
    const BodyState now = physics.state();
    Wrench wrench = motion.wrench(now);
    const double drag_1_s = 20.0 * std::clamp(-2.0 * now.time_s / kSettle_s, 0.0, 1.0);
    wrench.force_W_n -= drag_1_s * mass_kg * now.v_WB_m_s;
    wrench.torque_W_nm -= drag_1_s * inertia_kg_m2 * (now.q_WB * now.w_WB_B_rad_s);
    physics.step(wrench);
  }
  BodyState rest = physics.state();
  if (rest.v_WB_m_s.norm() > kRestSpeed_m_s)
    throw SimulationFailure("the robot did not come to rest before the recording starts (0 s)");
  rest.time_s = 0.0;
  physics.set_state(rest);
}

void append(const BodyState& state, Truth& truth) {
  truth.p_WB_m.push_back(state.p_WB_m);
  truth.q_WB.push_back(state.q_WB);
  truth.v_WB_m_s.push_back(state.v_WB_m_s);
  truth.w_WB_B_rad_s.push_back(state.w_WB_B_rad_s);
}

}  // namespace

Truth record_truth(engine::World& world, Motion& motion, double duration_s) {
  engine::Physics physics(world);
  settle(physics, *world.model, world.robot_body, motion);

  Truth truth;
  truth.period_ns = std::llround(physics.step_s() * 1e9);
  truth.p_BG_m = world.sphere_radius_m > 0.0 ? Eigen::Vector3d(-world.com_offset_m) : Eigen::Vector3d::Zero();
  truth.surfaces = world.surfaces;
  const double gravity_m_s2 = -world.model->opt.gravity[2];
  const std::int64_t steps = std::llround(duration_s / physics.step_s());

  BodyState before = physics.state();
  append(before, truth);
  physics.append_contacts(0, truth.contacts);
  double distance_m = 0.0;
  for (std::int64_t k = 1; k <= steps; ++k) {
    physics.step(motion.wrench(before));
    const BodyState after = physics.state();
    append(after, truth);
    truth.f_B_m_s2.push_back(specific_force_B(before, after, Eigen::Vector3d::Zero(), gravity_m_s2));
    physics.append_contacts(k * truth.period_ns, truth.contacts);
    distance_m = std::max(distance_m, (after.p_WB_m - truth.p_WB_m.front()).norm());
    before = after;
  }
  if (distance_m < kLeastDistance_m)
    throw SimulationFailure("the robot did not move until the end of the simulation at " + std::to_string(duration_s) +
                            " s");
  // Each specific force is the mean over the step that ends at its time. No step ends at time 0, so the specific force
  // of the first step is also used at time 0.
  truth.f_B_m_s2.insert(truth.f_B_m_s2.begin(), truth.f_B_m_s2.front());
  truth.label = label_contacts(truth);
  return truth;
}

}  // namespace tumble::sim
