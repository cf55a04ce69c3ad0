// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/held.hpp"

#include "sim/motion/rigid_body.hpp"

namespace tumble::sim {

HoldingHand::HoldingHand(const engine::World& world, const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& offset_W_m,
                         double height_m)
    : mass_kg_(world.model->body_mass[world.robot_body]),
      inertia_W_kg_m2_(tumble::sim::inertia_W_kg_m2(*world.model, world.robot_body, q_WB)),
      weight_n_(0.0, 0.0, -mass_kg_ * world.model->opt.gravity[2]) {
  if (!(height_m > 0.0))
    throw InvalidSituation("motion: the height of the held robot above the ground must be greater than 0");
  start_.q_WB = q_WB;
  start_.p_WB_m =
      world.start_W_m + offset_W_m + Eigen::Vector3d(0, 0, clearance_m(*world.model, world.robot_body, q_WB, height_m));
}

Wrench HoldingHand::hold(const BodyState& state) const {
  constexpr double kFrequency_rad_s = 12.0;  // typical of an arm
  const double stiffness_1_s2 = kFrequency_rad_s * kFrequency_rad_s, damping_1_s = 2.0 * kFrequency_rad_s;
  Wrench out;
  out.force_W_n =
      weight_n_ + mass_kg_ * (stiffness_1_s2 * (start_.p_WB_m - state.p_WB_m) - damping_1_s * state.v_WB_m_s);
  Eigen::Quaterniond error = start_.q_WB * state.q_WB.conjugate();
  if (error.w() < 0.0) error.coeffs() = -error.coeffs();
  out.torque_W_nm =
      inertia_W_kg_m2_ * (2.0 * stiffness_1_s2 * error.vec() - damping_1_s * (state.q_WB * state.w_WB_B_rad_s));
  return out;
}

}  // namespace tumble::sim
