// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sim/truth/record_truth.hpp"

namespace tumble::sim {

namespace {

Eigen::Vector3d log_rotation(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  // If the sine s is below 1e-4, the factor is a series: asin(s) / s = 1 + s^2 / 6, which is accurate to 1e-17.
  const double factor = sine < 1e-4 ? 2.0 * (1.0 + sine * sine / 6.0) : 2.0 * std::atan2(sine, q.w()) / sine;
  return factor * q.vec();
}

}  // namespace

Eigen::Vector3d mean_rate_B(const BodyState& before, const BodyState& after) {
  return log_rotation(before.q_WB.conjugate() * after.q_WB) / (after.time_s - before.time_s);
}

Eigen::Vector3d specific_force_B(const BodyState& before, const BodyState& after, const Eigen::Vector3d& p_BP_m,
                                 double gravity_m_s2) {
  const auto velocity = [&](const BodyState& s) -> Eigen::Vector3d {
    return s.v_WB_m_s + s.q_WB * s.w_WB_B_rad_s.cross(p_BP_m);
  };
  const Eigen::Vector3d a_W = (velocity(after) - velocity(before)) / (after.time_s - before.time_s);
  const Eigen::Quaterniond middle = before.q_WB.slerp(0.5, after.q_WB);
  return middle.conjugate() * (a_W + Eigen::Vector3d(0, 0, gravity_m_s2));
}

}  // namespace tumble::sim
