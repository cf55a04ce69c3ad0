// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kWindow_s = 0.002;  // averaging time, about the inverse bandwidth of the IMUs
constexpr double kAfterTouch_s = 0.06;

const std::array<Eigen::Quaterniond, 4>& attitudes() {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  static const std::array<Eigen::Quaterniond, 4> kAll = {
      Eigen::Quaterniond(AngleAxisd(0.8, Vector3d(1, 1, 0).normalized())),
      Eigen::Quaterniond(AngleAxisd(0.7, Vector3d::UnitX())), Eigen::Quaterniond(AngleAxisd(0.4, Vector3d::UnitY())),
      Eigen::Quaterniond(AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized()))};
  return kAll;
}

double peak_m_s2(const CertificateInput& input, const Eigen::Quaterniond& attitude, double height_m, double step_s,
                 double contact_time_s) {
  sim::Situation situation = bare_room("rig");
  situation.robot.values.set("contact_time_s", contact_time_s);
  sim::Trial trial(build(input, situation), {step_s});
  sim::BodyState start;
  start.p_WB_m.z() = height_m;
  start.q_WB = attitude;
  trial.set_state(start);
  const std::int64_t window = std::max<std::int64_t>(1, std::llround(kWindow_s / trial.step_s()));
  std::vector<Eigen::Vector3d> v_m_s = {start.v_WB_m_s};
  double peak = 0.0, end_s = 5.0;
  while (trial.state().time_s < end_s) {
    trial.step();
    v_m_s.push_back(trial.state().v_WB_m_s);
    if (end_s == 5.0 && !trial.contacts().empty()) end_s = trial.state().time_s + kAfterTouch_s;
    const auto now = static_cast<std::int64_t>(v_m_s.size()) - 1;
    if (now < window) continue;
    const double span_s = static_cast<double>(window) * trial.step_s();
    const Eigen::Vector3d a_W = (v_m_s.back() - v_m_s[static_cast<std::size_t>(now - window)]) / span_s;
    peak = larger(peak, (a_W + Eigen::Vector3d(0, 0, trial.gravity_m_s2())).norm());
  }
  return peak;
}

double own_step_s(const CertificateInput& input) {
  return sim::Trial(build(input, bare_room("rig"))).step_s();
}

}  // namespace

std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup) {
  const double middle_s = std::sqrt(setup.soft_s * setup.hard_s);
  const double step_s = setup.step_s > 0.0 ? setup.step_s : own_step_s(input);
  double step_change = 0.0, exponent = 0.0;
  for (const Eigen::Quaterniond& attitude : attitudes()) {
    const double here = peak_m_s2(input, attitude, setup.height_m, step_s, middle_s);
    const double finer = peak_m_s2(input, attitude, setup.height_m, own_step_s(input) / 4.0, middle_s);
    step_change = larger(step_change, std::abs(here / finer - 1.0));
    const double soft = peak_m_s2(input, attitude, setup.height_m, step_s, setup.soft_s);
    const double hard = peak_m_s2(input, attitude, setup.height_m, step_s, setup.hard_s);
    exponent += std::log(soft / hard) / std::log(setup.soft_s / setup.hard_s) / attitudes().size();
  }
  return {{"impact_peak_step", "rig",
           "the peak force of the first impact does not depend on the time step; the value is the maximum relative "
           "change if the time step is divided by four",
           "1", step_change, 0.0, 0.05, ""},
          {"impact_peak_softness", "rig",
           "the peak force of an impact is inversely proportional to the contact's time constant, as for a spring; the "
           "value is the mean exponent of four landings (expected: -1)",
           "1", exponent, -1.3, -0.7, ""}};
}

}  // namespace tumble::scenarios
