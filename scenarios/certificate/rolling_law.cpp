// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/scenario.hpp"
#include "sim/simulate.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kMoving_m_s = 0.05;

struct Lengths {
  double path_length_m = 0.0, missed_m = 0.0;
};

/// Compares the velocity of a sphere's centre with the rolling law v = r w x n (radius r, angular velocity w, contact
/// normal n). If the sphere has several contacts, n is the normal of the contact with the largest load.
Lengths compare(const sim::Truth& truth, double radius_m) {
  Lengths lengths;
  const double dt_s = static_cast<double>(truth.period_ns) * 1e-9;
  for (std::size_t i = 0; i < truth.contacts.size();) {
    const std::int64_t time_ns = truth.contacts[i].time_ns;
    const sim::ContactTruth* strongest = &truth.contacts[i];
    for (; i < truth.contacts.size() && truth.contacts[i].time_ns == time_ns; ++i) {
      if (truth.contacts[i].normal_force_n > strongest->normal_force_n) strongest = &truth.contacts[i];
    }
    const auto k = static_cast<std::size_t>(time_ns / truth.period_ns);
    if (truth.label[k] != sim::ContactLabel::grip) continue;
    const Eigen::Vector3d w_W = truth.q_WB[k] * truth.w_WB_B_rad_s[k];
    const Eigen::Vector3d v_G_m_s = truth.v_WB_m_s[k] + w_W.cross(truth.q_WB[k] * truth.p_BG_m);
    const Eigen::Vector3d along = v_G_m_s - v_G_m_s.dot(strongest->normal_W) * strongest->normal_W;
    if (along.norm() < kMoving_m_s) continue;
    lengths.path_length_m += along.norm() * dt_s;
    lengths.missed_m += (along - radius_m * w_W.cross(strongest->normal_W)).norm() * dt_s;
  }
  return lengths;
}

CertificateEntry entry(const CertificateInput& input, const RollingSetup& setup,
                       const sim::ResolvedSituation& situation, const std::string& subject, double high) {
  const auto every = [](const sim::SensorSpec&) { return true; };
  const sim::BuiltSituation built(situation.without_sensors(every), input.data.models());
  const sim::Recording recording = sim::simulate(built);
  const double own_m = recording.sensors.sphere_radius_m;
  const Lengths lengths = compare(recording.truth, setup.stated_radius_m > 0.0 ? setup.stated_radius_m : own_m);
  return {"rolling_law",
          subject,
          "the centre of a sphere without slip moves with the velocity r w x n (r: radius, w: rate, n: floor normal). "
          "The value is the share of the path that violates this law",
          "1",
          lengths.missed_m / lengths.path_length_m,
          0.0,
          high,
          lengths.path_length_m > 0.0 ? "" : "the sphere never rolled"};
}

}  // namespace

std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup) {
  sim::Situation plane = bare_room("sphere");
  plane.duration_s = 4.5;
  plane.motion.values.set("rest_s", 0.5);
  plane.motion.values.set("leg_2_m", 0.0);
  plane.robot.values.set("inner_x_m", 0.008);
  plane.robot.values.set("inner_z_m", -0.01);
  std::vector<CertificateEntry> entries = {entry(input, setup, sim::resolve(plane), "plane", 1e-3)};
  if (!setup.terrains) return entries;
  constexpr double kTerrainHigh = 1e-3;
  for (const std::string& name : scenario_names(input.data)) {
    const Scenario scenario = load_scenario(input.data, name);
    if (scenario.robot.type != "sphere" || scenario.motion.type == "throw") continue;  // a thrown sphere bounces
    entries.push_back(entry(input, setup, draw(input.data, scenario, 1), name, kTerrainHigh));
  }
  return entries;
}

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
           "a sliding sphere with initial speed v0, friction mu, gravity g, mass m, radius r and inertia I grips after "
           "the time v0 / (mu g (1 + m r^2 / I)). The value is the relative error of the simulated time",
           "1", gripped_s / expected_s - 1.0, -0.01, 0.01, ""}};
}

}  // namespace tumble::scenarios
