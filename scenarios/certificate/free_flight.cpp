// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "sim/imu/imu_simulation.hpp"

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
  return {{"free_flight_energy", "rig",
           "a body without torque keeps its rotational energy; the value is the maximum relative change in 5 s", "1",
           energy_drift, 0.0, 1e-8, ""},
          {"free_flight_momentum", "rig",
           "a body without torque keeps its angular momentum in the world frame; the value is the maximum relative "
           "change in 5 s",
           "1", momentum_drift, 0.0, 1e-5, ""}};
}

std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup) {
  sim::Trial trial(build(input, bare_room("rig")));
  trial.set_state(thrown(setup.rate_rad_s));
  const sim::Truth truth = fly(trial, setup.duration_s);

  sim::SensorSpec ideal;
  ideal.name = "imu";
  ideal.kind = "imu";
  ideal.values.set("output_rate_hz", 1.0 / trial.step_s());
  ideal.values = sim::resolve("certificate.imu", ideal.values, sim::imu_parameters());
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.translation().x() = setup.lever_arm_m;
  sim::ImuRecord record;
  sim::ImuTruth imu_truth;
  sim::simulate_imu(truth, ideal, T_BI, trial.gravity_m_s2(), 1, record, imu_truth);

  double largest_m_s2 = 0.0;
  for (const Eigen::Vector3d& f : record.accel_m_s2) largest_m_s2 = larger(largest_m_s2, f.norm());
  return {{"flight_specific_force", "rig",
           "an ideal accelerometer at the centre of mass reads zero in free flight; the value is the maximum reading",
           "m/s^2", largest_m_s2, 0.0, 1e-6, ""}};
}

std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup) {
  sim::Trial trial(build(input, bare_room("sphere")));
  sim::BodyState start;
  start.p_WB_m.z() = trial.sphere_radius_m() + setup.height_m - trial.p_BG_m().z();
  trial.set_state(start);
  const double expected_s = std::sqrt(2.0 * setup.stated_height_m / trial.gravity_m_s2());
  double touched_s = std::numeric_limits<double>::quiet_NaN();
  while (std::isnan(touched_s) && trial.state().time_s < 10.0 * expected_s + 1.0) {
    trial.step();
    if (!trial.contacts().empty()) touched_s = trial.state().time_s;
  }
  return {{"free_fall_time", "sphere",
           "a fall from height h with gravity g takes the time sqrt(2 h / g). The value is the error of the simulated "
           "time, in time steps of the simulation",
           "1", (touched_s - expected_s) / trial.step_s(), -0.01, 1.01, ""}};
}

}  // namespace tumble::scenarios
