// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"

namespace tumble::scenarios {

namespace {

double slip_m_s(const sim::BodyState& state, double radius_m) {
  return state.v_WB_m_s.x() - radius_m * (state.q_WB * state.w_WB_B_rad_s).y();
}

}  // namespace

std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup) {
  sim::Situation situation = bare_room("sphere");
  situation.world.values.set("friction", setup.friction);
  sim::Trial trial(build(input, situation));
  const double radius_m = trial.sphere_radius_m();

  sim::BodyState state;
  state.p_WB_m.z() = radius_m;
  trial.set_state(state);
  for (int k = 0; k < 1000; ++k) trial.step();  // lets the contact settle
  state = trial.state();
  state.time_s = 0.0;
  state.v_WB_m_s = {setup.speed_m_s, 0.0, 0.0};
  trial.set_state(state);

  constexpr double kLeftOver = 0.005;
  const double mass_kg = trial.mass_kg(), inertia_kg_m2 = trial.inertia_B_kg_m2()(1, 1);
  const double expected_s =
      (1.0 - kLeftOver) * setup.speed_m_s /
      (setup.stated_friction * trial.gravity_m_s2() * (1.0 + mass_kg * radius_m * radius_m / inertia_kg_m2));
  double before_m_s = setup.speed_m_s, gripped_s = std::numeric_limits<double>::quiet_NaN();
  while (std::isnan(gripped_s) && trial.state().time_s < 5.0 * expected_s) {
    trial.step();
    const double now_m_s = slip_m_s(trial.state(), radius_m), level = kLeftOver * setup.speed_m_s;
    if (now_m_s < level) {
      gripped_s = trial.state().time_s - trial.step_s() * (level - now_m_s) / (before_m_s - now_m_s);
    }
    before_m_s = now_m_s;
  }
  return {{"slip_to_grip_time", "sphere",
           "a sphere that starts to slide at the speed v0 grips after the time v0 / (mu g (1 + m r^2 / I)): relative "
           "difference (mu: friction coefficient; m, r, I: mass, radius and moment of inertia)",
           "1", gripped_s / expected_s - 1.0, -0.01, 0.01, ""}};
}

}  // namespace tumble::scenarios
