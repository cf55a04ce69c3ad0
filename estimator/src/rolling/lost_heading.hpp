// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// Prevents false information about the heading, which contact does not determine. The readings do not change if a
/// whole run is rotated about the vertical. A linearised filter with a large heading error still gains false
/// information, because the linearisation points of successive updates differ: rolling.md (R34) to (R36).
namespace tumble::rolling {

/// Standard deviation of the heading above which the correction is applied. The false information is quadratic in the
/// standard deviation.
inline constexpr double kLostHeading_rad = 0.1;

inline bool lost_heading(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Removes the effect of a rotation of the whole run from the derivative of the contact velocity. The true effect is
/// zero while the contact point does not move. (R35)
inline void blind_to_heading(Contact& c) {
  c.H.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.u_W_m_s);
}

/// Returns the change that a move of the nominal by `x` causes in the effect of a rotation about the vertical on
/// velocity, position and slope. (R36)
inline Vector turned_by_heading(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance P of errors about the old nominal to errors about the new nominal: P <- T P T^T. (R36)
inline void move_errors(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

/// Same for one error.
inline void move_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
