// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/autogain_fusion.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/baselines/attitude/force_min.hpp"
#include "scenarios/baselines/rolling/attitude_check.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

namespace {

/// A rolling sphere moves along an axis only if the sphere rotates about another axis. Therefore, coupling() returns
/// for each velocity axis the larger rotation factor of the two other axes (Zevering et al. 2021, eq 8).
Eigen::Vector3d coupling(const Eigen::Vector3d& factor) {
  return {std::max(factor.y(), factor.z()), std::max(factor.x(), factor.z()), std::max(factor.x(), factor.y())};
}

}  // namespace

AutogainFusion::AutogainFusion(const Params& p) : params_(p), autogain_(p.autogain) {
  require_valid_fields(p);
}

Status AutogainFusion::step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (const Status bad = check_attitude(q_WI); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
    const Eigen::Vector3d v_acc_W = accelerated(sample, q_WI, dt_s, state);
    const Eigen::Vector3d v_rot_W =
        params_.radius_m * (q_WI * sample.angular_velocity_rad_s).cross(Eigen::Vector3d::UnitZ());
    state.v_WG_m_s = fuse(v_acc_W, v_rot_W);
    state.p_WG_m += dt_s * state.v_WG_m_s;
  }
  state.last_time_ns = sample.time_ns;
  state.started = true;
  return {};
}

Eigen::Vector3d AutogainFusion::accelerated(const ImuSample& sample, const Eigen::Quaterniond& q_WI, double dt_s,
                                            State& state) const {
  const double length = sample.specific_force_m_s2.norm();
  const double unit = params_.direction_only ? std::max(length, kForceMin_m_s2) : params_.gravity_m_s2;
  // The specific force is a mean over the averaging window, so gravity is rotated by the attitude in the middle of the
  // window.
  const Eigen::Quaterniond q_mid = q_WI * so3::exp(-0.5 * dt_s * sample.angular_velocity_rad_s);
  const Eigen::Vector3d up_I = q_mid.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d linear_g = sample.specific_force_m_s2 / unit - up_I;
  const Eigen::Vector3d a_I = (params_.direction_only ? 1.0 : params_.gravity_m_s2) * linear_g;
  const Eigen::Vector3d scale = coupling(autogain_.gains(sample.angular_velocity_rad_s, dt_s).factor);

  const Eigen::Quaterniond q = params_.integrate_in_body ? Eigen::Quaterniond::Identity() : q_WI;
  state.v_integral_m_s += dt_s * (params_.integrate_in_body ? a_I : q_mid * a_I);
  const Eigen::Vector3d gated_I = scale.cwiseProduct(q.conjugate() * state.v_integral_m_s);
  if (params_.recursive_coupling) state.v_integral_m_s = q * gated_I;
  return q_WI * gated_I;
}

Eigen::Vector3d AutogainFusion::fuse(const Eigen::Vector3d& v_acc_W, const Eigen::Vector3d& v_rot_W) const {
  Eigen::Vector2d acc = v_acc_W.head<2>(), rot = v_rot_W.head<2>();
  const double speed = rot.norm();
  if (params_.limit_per_axis) {
    const Eigen::Vector2d bound = params_.limiter * rot.cwiseAbs();
    acc = acc.cwiseMax(-bound).cwiseMin(bound);
  } else if (acc.norm() > params_.limiter * speed) {
    acc *= params_.limiter * speed / acc.norm();
  }
  const double climb_max = params_.vertical_by_norm ? speed : 0.5 * (std::abs(rot.x()) + std::abs(rot.y()));
  const double climb = std::clamp(v_acc_W.z(), -climb_max, climb_max);
  if (params_.shrink_per_axis) {
    for (int axis = 0; axis < 2; ++axis) {
      rot[axis] = std::copysign(std::sqrt(std::max(0.0, rot[axis] * rot[axis] - climb * climb)), rot[axis]);
    }
  } else if (speed > 0.0) {
    rot *= std::sqrt(std::max(0.0, 1.0 - climb * climb / (speed * speed)));
  }
  const Eigen::Vector2d fused = params_.acceleration_weight * acc + params_.rotation_weight * rot;
  return {fused.x(), fused.y(), climb};
}

}  // namespace tumble::baselines
