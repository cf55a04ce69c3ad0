// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"

namespace tumble::scenarios {

std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup) {
  sim::Trial trial(build(input, bare_room("rig")), {0.0, setup.integrator});
  const Eigen::Matrix3d inertia = trial.inertia_B_kg_m2();
  const auto energy_j = [&](const sim::BodyState& s) { return 0.5 * s.w_WB_B_rad_s.dot(inertia * s.w_WB_B_rad_s); };
  const auto momentum_W = [&](const sim::BodyState& s) -> Eigen::Vector3d {
    return s.q_WB * (inertia * s.w_WB_B_rad_s);
  };

  const sim::BodyState start = thrown(setup.rate_rad_s);
  trial.set_state(start);
  double energy_drift = 0.0, momentum_drift = 0.0;
  const std::int64_t steps = std::llround(setup.duration_s / trial.step_s());
  for (std::int64_t k = 0; k < steps; ++k) {
    trial.step();
    const sim::BodyState now = trial.state();
    energy_drift = larger(energy_drift, std::abs(energy_j(now) / energy_j(start) - 1.0));
    momentum_drift = larger(momentum_drift, (momentum_W(now) - momentum_W(start)).norm() / momentum_W(start).norm());
  }
  return {
      {"free_flight_energy", "rig", "a body without torque keeps its rotational energy: maximum relative change in 5 s",
       "1", energy_drift, 0.0, 1e-8, ""},
      {"free_flight_momentum", "rig",
       "a body without torque keeps its angular momentum in the world frame: maximum relative change in 5 s", "1",
       momentum_drift, 0.0, 1e-5, ""}};
}

}  // namespace tumble::scenarios
