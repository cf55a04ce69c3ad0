// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_observation.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>

#include "tumble/common/types.hpp"

namespace tumble {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Returns a matrix with the columns S_i v, where S_i are the five basis matrices of the inertia
// (BodyImuConstants::inertia_basis_matrix).
Eigen::Matrix<double, 3, 5> inertia_basis_products(const Vector3d& v) {
  constexpr double kHalf = 0.5 * std::numbers::sqrt2, kSixth = std::numbers::inv_sqrt3 * kHalf;
  Eigen::Matrix<double, 3, 5> out;
  out << kHalf * v[0], kSixth * v[0], kHalf * v[1], kHalf * v[2], 0.0,  //
      -kHalf * v[1], kSixth * v[1], kHalf * v[0], 0.0, kHalf * v[2],    //
      0.0, -2.0 * kSixth * v[2], 0.0, kHalf * v[0], kHalf * v[1];
  return out;
}

struct Jerk {
  Matrix3d J, J_inv;
  Vector3d rate_jerk, acceleration_jerk, value;
};

// Returns the angular jerk of a body without torque: rate_smoother.md (R11).
Jerk jerk_of(const AngularRateKnot& knot, const BodyImuConstants& rig) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2;
  Jerk out;
  out.J = rig.inertia_matrix_with_trace_3();
  out.J_inv = out.J.inverse();
  out.rate_jerk = out.J * w;
  out.acceleration_jerk = out.J * alpha;
  out.value = -out.J_inv * (alpha.cross(out.rate_jerk) + w.cross(out.acceleration_jerk));
  return out;
}

struct JerkDerivatives {
  Matrix3d jacobian_rate, jacobian_acceleration;
  Eigen::Matrix<double, 3, 5> jacobian_inertia;
};

JerkDerivatives jerk_derivatives_of(const Jerk& jerk, const AngularRateKnot& knot) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2;
  JerkDerivatives out;
  out.jacobian_rate = -jerk.J_inv * (so3::hat(alpha) * jerk.J - so3::hat(jerk.acceleration_jerk));
  out.jacobian_acceleration = -jerk.J_inv * (so3::hat(w) * jerk.J - so3::hat(jerk.rate_jerk));
  Eigen::Matrix<double, 3, 5> moved = inertia_basis_products(jerk.value);
  moved.noalias() += so3::hat(alpha).lazyProduct(inertia_basis_products(w));
  moved.noalias() += so3::hat(w).lazyProduct(inertia_basis_products(alpha));
  out.jacobian_inertia = -jerk.J_inv.lazyProduct(moved);
  return out;
}

// Propagates rate and angular acceleration back in time by `delay_s`, for rotation without torque: rate_smoother.md
// (R12).
AngularRateKnot knot_before(double delay_s, const AngularRateKnot& knot, const Jerk& jerk) {
  const double half = 0.5 * delay_s * delay_s;
  return {knot.rate_rad_s - delay_s * knot.acceleration_rad_s2 + half * jerk.value,
          knot.acceleration_rad_s2 - delay_s * jerk.value};
}

}  // namespace

// See rate_smoother.md (R6). The caller propagates `knot`, a pair of rate and angular acceleration, to the time of the
// gyro reading: rate_smoother.md (R7).
AngularRateFactor gyro_factor(const AngularRateKnot& knot, const BodyImuConstants& rig, const Vector3d& reading_rad_s) {
  AngularRateFactor f;
  f.residual = knot.rate_rad_s + rig.gyro_bias_rad_s - reading_rad_s;
  f.jacobian_knot << Matrix3d::Identity(), Matrix3d::Zero();
  f.jacobian_calibration.setZero();
  f.jacobian_calibration.middleCols<3>(3).setIdentity();
  return f;
}

// See rate_smoother.md (R8), rails.md (R52).
AngularRateFactor sensing_axis_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Vector3d& reading_rad_s) {
  const Vector3d off = knot.rate_rad_s + rig.gyro_bias_rad_s - reading_rad_s;
  AngularRateFactor f;
  f.jacobian_knot.setZero();
  f.jacobian_calibration.setZero();
  for (int j = 0; j < 3; ++j) {
    const Vector3d row = rig.gyro_sensing_direction(j);
    f.residual[j] = row.dot(off);
    f.jacobian_knot.row(j).head<3>() = row;
    f.jacobian_calibration.row(j).segment<3>(3) = row;
    f.jacobian_calibration(j, BodyImuConstants::kGyroMisalignmentIndex + 2 * j) = off[(j + 1) % 3];
    f.jacobian_calibration(j, BodyImuConstants::kGyroMisalignmentIndex + 2 * j + 1) = off[(j + 2) % 3];
  }
  return f;
}

// See rate_smoother.md (R10).
AngularRateFactor flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Vector3d& reading_m_s2) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2, &t = rig.lever_arm_m;
  AngularRateFactor f;
  f.residual = alpha.cross(t) + w.cross(w.cross(t)) + rig.accel_bias_m_s2 - reading_m_s2;
  // derivative of the centripetal force w x (w x t) = w (w.t) - t (w.w) at the lever arm t with respect to the rate w
  f.jacobian_knot << w * t.transpose() + w.dot(t) * Matrix3d::Identity() - 2.0 * t * w.transpose(), -so3::hat(t);
  f.jacobian_calibration.setZero();
  f.jacobian_calibration.middleCols<3>(0) =
      so3::hat(alpha) + w * w.transpose() - w.squaredNorm() * Matrix3d::Identity();
  f.jacobian_calibration.middleCols<3>(6).setIdentity();
  return f;
}

// See rate_smoother.md (R12).
AngularRateFactor delayed_flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                              const Vector3d& reading_m_s2, double delay_s, Vector3d* jacobian_delay) {
  const Jerk jerk = jerk_of(knot, rig);
  const JerkDerivatives derivatives = jerk_derivatives_of(jerk, knot);
  const double d = delay_s, half = 0.5 * delay_s * delay_s;
  const AngularRateFactor at = flight_force_factor(knot_before(d, knot, jerk), rig, reading_m_s2);
  const Matrix3d by_rate = at.jacobian_knot.leftCols<3>(), jacobian_acceleration = at.jacobian_knot.rightCols<3>();
  AngularRateFactor f = at;
  f.jacobian_knot.leftCols<3>() = by_rate + (half * by_rate - d * jacobian_acceleration) * derivatives.jacobian_rate;
  f.jacobian_knot.rightCols<3>() = jacobian_acceleration - d * by_rate +
                                   (half * by_rate - d * jacobian_acceleration) * derivatives.jacobian_acceleration;
  f.jacobian_calibration.middleCols<5>(9) = (half * by_rate - d * jacobian_acceleration) * derivatives.jacobian_inertia;
  if (jacobian_delay != nullptr) {
    *jacobian_delay = by_rate * (d * jerk.value - knot.acceleration_rad_s2) - jacobian_acceleration * jerk.value;
  }
  return f;
}

// See rate_smoother.md (R12).
AngularRateFactor delayed_flight_calibration_jacobian(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                                      const Vector3d& reading_m_s2, double delay_s) {
  AngularRateFactor f = flight_force_factor(knot_before(delay_s, knot, jerk_of(knot, rig)), rig, reading_m_s2);
  f.jacobian_knot.setZero();
  return f;
}

// See rate_smoother.md (R13).
Vector3d flight_angular_jerk(const AngularRateKnot& knot, const BodyImuConstants& rig) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2, &t = rig.lever_arm_m;
  const Jerk jerk = jerk_of(knot, rig);
  const Vector3d& j = jerk.value;
  const Vector3d snap = -jerk.J_inv * (j.cross(jerk.rate_jerk) + 2.0 * alpha.cross(jerk.acceleration_jerk) +
                                       w.cross(Vector3d(jerk.J * j)));
  return snap.cross(t) + j.cross(w.cross(t)) + 2.0 * alpha.cross(alpha.cross(t)) + w.cross(j.cross(t));
}

// See rate_smoother.md (R14).
AngularRateFactor euler_equation_factor(const AngularRateKnot& knot, const BodyImuConstants& rig) {
  const Vector3d &w = knot.rate_rad_s, &alpha = knot.acceleration_rad_s2;
  const Matrix3d J = rig.inertia_matrix_with_trace_3();
  const Vector3d momentum = J * w;
  AngularRateFactor f;
  f.residual = J * alpha + w.cross(momentum);
  f.jacobian_knot << so3::hat(w) * J - so3::hat(momentum), J;
  f.jacobian_calibration.setZero();
  f.jacobian_calibration.middleCols<5>(9) = inertia_basis_products(alpha);
  f.jacobian_calibration.middleCols<5>(9).noalias() += so3::hat(w).lazyProduct(inertia_basis_products(w));
  return f;
}

}  // namespace tumble
