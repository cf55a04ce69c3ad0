// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/hand.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tumble::sim {

namespace {

constexpr double kTremorLow_hz = 0.7, kTremorHigh_hz = 9.0;
// speed of the sphere above which the tremor of the hand has its full amplitude
constexpr double kFullTremor_m_s = 0.1;

/// Returns the rotation that turns the unit vector `from` to the z axis. The function replaces Eigen's
/// setFromTwoVectors, whose compilation would take 6 s.
Eigen::Quaterniond turn_up(const Eigen::Vector3d& from) {
  const double cosine = from.z();
  if (cosine < -1.0 + 1e-12) return {0.0, 1.0, 0.0, 0.0};
  const Eigen::Vector3d axis = from.cross(Eigen::Vector3d::UnitZ());
  const double s = std::sqrt((1.0 + cosine) * 2.0), inverse = 1.0 / s;
  return {s * 0.5, axis.x() * inverse, axis.y() * inverse, axis.z() * inverse};
}

}  // namespace

Hand::Hand(const std::string& motion, const Values& values, const engine::World& world)
    : world_(world), values_(values), radius_m_(world.sphere_radius_m), p_BG_m_(-world.com_offset_m) {
  if (radius_m_ <= 0.0) throw InvalidSituation("motion." + motion + ": this motion needs the robot 'sphere'");
  const mjModel& model = *world.model;
  mass_kg_ = model.body_mass[world.robot_body];
  inertia_kg_m2_ = Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * world.robot_body).mean();
  for (std::size_t i = 0; i < kHandPatches; ++i) {
    const std::string name = "patch_" + std::to_string(i + 1);
    bursts_[i] = {values.at(name + "_spin_ratio"), values.at(name + "_axis_rad")};
  }
  Stream stream(static_cast<std::uint64_t>(values.at("hand_seed")), "hand.tremor");
  for (int axis = 0; axis < 2; ++axis)
    force_.emplace_back(stream, values.at("tremor_n"), kTremorLow_hz, kTremorHigh_hz);
  for (int axis = 0; axis < 3; ++axis)
    torque_.emplace_back(stream, values.at("tremor_nm"), kTremorLow_hz, kTremorHigh_hz);
}

BodyState Hand::at_rest(const Eigen::Vector3d& p_G_m) const {
  BodyState state;
  if (p_BG_m_.norm() > 1e-6) state.q_WB = turn_up(p_BG_m_.normalized());
  state.p_WB_m = p_G_m - state.q_WB * p_BG_m_;
  return state;
}

Wrench Hand::wrench(const BodyState& state, const Reference& reference) {
  const Eigen::Vector3d r_BG_m = state.q_WB * p_BG_m_;
  const Eigen::Vector3d w_W = state.q_WB * state.w_WB_B_rad_s;
  const Eigen::Vector3d p_G = state.p_WB_m + r_BG_m;
  const Eigen::Vector3d v_G = state.v_WB_m_s + w_W.cross(r_BG_m);
  const double unsteady = std::min(reference.v_m_s.norm() / kFullTremor_m_s, 1.0);

  Wrench out;
  const double rolling_mass_kg = mass_kg_ + inertia_kg_m2_ / (radius_m_ * radius_m_);
  out.force_W_n = values_.at("stiffness_n_m") * (reference.p_m - p_G) +
                  values_.at("damping_n_s_m") * (reference.v_m_s - v_G) + rolling_mass_kg * reference.a_m_s2;
  for (int axis = 0; axis < 2; ++axis) out.force_W_n[axis] += unsteady * force_[axis].at(state.time_s);
  out.force_W_n.z() = 0.0;
  out.torque_W_nm = r_BG_m.cross(out.force_W_n);
  out.torque_W_nm.z() -= values_.at("twist_damping_nm_s") * w_W.z();
  for (int axis = 0; axis < 3; ++axis) out.torque_W_nm[axis] += unsteady * torque_[axis].at(state.time_s);
  out.torque_W_nm += burst(state.time_s, p_G, reference.v_m_s, w_W);
  return out;
}

Eigen::Vector3d Hand::burst(double time_s, const Eigen::Vector3d& p_G_m, const Eigen::Vector3d& v_m_s,
                            const Eigen::Vector3d& w_W_rad_s) {
  for (std::size_t i = 0; i < std::min(world_.patches.size(), kHandPatches); ++i) {
    Burst& burst = bursts_[i];
    if (burst.spin_ratio == 1.0 || !world_.patches[i].contains(p_G_m.x(), p_G_m.y())) continue;
    if (std::isinf(burst.end_s)) burst.end_s = time_s + values_.at("burst_s");
    if (time_s >= burst.end_s) continue;
    const Eigen::Vector3d rolling = Eigen::Vector3d::UnitZ().cross(v_m_s) / radius_m_;
    const Eigen::Vector3d aim =
        burst.spin_ratio * (Eigen::AngleAxisd(burst.axis_rad, Eigen::Vector3d::UnitZ()) * rolling);
    const Eigen::Vector3d torque = inertia_kg_m2_ / values_.at("burst_time_s") * (aim - w_W_rad_s);
    const double size = torque.norm(), limit = values_.at("torque_limit_nm");
    return size > limit ? Eigen::Vector3d(torque * (limit / size)) : torque;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace tumble::sim
