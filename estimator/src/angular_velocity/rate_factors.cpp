// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_factors.hpp"

#include <Eigen/Geometry>

#include "tumble/common/so3.hpp"

namespace tumble {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RateFactor gyro_factor(const RateKnot& knot, const RigConstants& rig, const Vector3d& reading_rad_s) {
  RateFactor f;
  f.residual = knot.rate_rad_s + rig.gyro_bias_rad_s - reading_rad_s;
  f.by_knot << Matrix3d::Identity(), Matrix3d::Zero();
  f.by_rig.setZero();
  f.by_rig.middleCols<3>(3).setIdentity();
  return f;
}

RateFactor flight_factor(const RateKnot& knot, const RigConstants& rig, const Vector3d& reading_m_s2) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2, &t = rig.lever_arm_m;
  RateFactor f;
  f.residual = alpha.cross(t) + w.cross(w.cross(t)) + rig.accel_bias_m_s2 - reading_m_s2;
  // w x (w x t) = w (w.t) - t (w.w)
  f.by_knot << w * t.transpose() + w.dot(t) * Matrix3d::Identity() - 2.0 * t * w.transpose(), -so3::hat(t);
  f.by_rig.setZero();
  f.by_rig.middleCols<3>(0) = so3::hat(alpha) + w * w.transpose() - w.squaredNorm() * Matrix3d::Identity();
  f.by_rig.middleCols<3>(6).setIdentity();
  return f;
}

RateFactor euler_factor(const RateKnot& knot, const RigConstants& rig) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2;
  const Matrix3d J = rig.inertia_matrix();
  const Vector3d momentum = J * w;
  RateFactor f;
  f.residual = J * alpha + w.cross(momentum);
  f.by_knot << so3::hat(w) * J - so3::hat(momentum), J;
  f.by_rig.setZero();
  for (int i = 0; i < 5; ++i) {
    const Matrix3d& S = RigConstants::inertia_basis(i);
    f.by_rig.col(9 + i) = S * alpha + w.cross(Vector3d(S * w));
  }
  return f;
}

}  // namespace tumble
