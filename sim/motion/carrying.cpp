// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/carrying.hpp"

#include <algorithm>

namespace tumble::sim {

namespace {

Eigen::Vector3d turn(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd turned(from.conjugate() * to);
  return turned.angle() * turned.axis();
}

}  // namespace

Wrench carry_along(const HoldingHand& hand, const Eigen::Matrix3d& inertia_B_kg_m2, const BodyState& state,
                   const HandHeldPath& path) {
  constexpr double kDifference_s = 1e-3;  // for derivatives of the path
  // Natural frequency of the spring and damper between hand and body. The frequency is high, so that spring and damper
  // transmit the tremor of the hand.
  constexpr double kFrequency_rad_s = 60.0;
  constexpr double kStiffness_1_s2 = kFrequency_rad_s * kFrequency_rad_s, kDamping_1_s = 2.0 * kFrequency_rad_s;
  const HandHeldPose before = path(state.time_s - kDifference_s), now = path(state.time_s),
                     after = path(state.time_s + kDifference_s);
  const Eigen::Vector3d v_m_s = (after.p_m - before.p_m) / (2.0 * kDifference_s);
  const Eigen::Vector3d a_m_s2 = (after.p_m - 2.0 * now.p_m + before.p_m) / (kDifference_s * kDifference_s);
  const Eigen::Vector3d first = turn(before.q, now.q), second = turn(now.q, after.q);
  const Eigen::Vector3d w_rad_s = (first + second) / (2.0 * kDifference_s);
  const Eigen::Vector3d alpha_rad_s2 = (second - first) / (kDifference_s * kDifference_s);

  Wrench out;
  out.force_W_n = hand.weight_n() + hand.mass_kg() * (a_m_s2 + kStiffness_1_s2 * (now.p_m - state.p_WB_m) +
                                                      kDamping_1_s * (v_m_s - state.v_WB_m_s));
  const Eigen::Vector3d aim_rad_s2 =
      alpha_rad_s2 + kStiffness_1_s2 * turn(state.q_WB, now.q) + kDamping_1_s * (w_rad_s - state.w_WB_B_rad_s);
  out.torque_W_nm =
      state.q_WB * (inertia_B_kg_m2 * aim_rad_s2 + state.w_WB_B_rad_s.cross(inertia_B_kg_m2 * state.w_WB_B_rad_s));
  return out;
}

Eigen::Matrix3d carried_inertia_B_kg_m2(const HoldingHand& hand) {
  const Eigen::Quaterniond q_WB = hand.start().q_WB;
  return q_WB.conjugate() * hand.inertia_W_kg_m2() * q_WB;
}

double eased(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

}  // namespace tumble::sim
