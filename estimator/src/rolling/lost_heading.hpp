// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// Prevents false information about the heading, which contact does not determine. A whole run rotated about the
/// vertical gives the same readings. A linearised filter with a large heading error still gains false information,
/// because the linearisation points of successive updates differ: rolling.md (R34) to (R36).
namespace tumble::rolling {

/// Standard deviation of the heading above which this correction is applied; the false information is quadratic in it.
inline constexpr double kLostHeading_rad = 0.1;

inline bool lost_heading(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Removes the effect of a rotation of the whole run from the derivative of the contact velocity. The true effect is
/// zero while the contact point does not move. (R35)
inline void blind_to_heading(Contact& c) {
  c.H.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.u_W_m_s);
}

/// Returns the change of the effect of a rotation about the vertical on velocity, position and slope, when the nominal
/// moves by `x`. (R36)
inline Vector turned_by_heading(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance of errors about the old nominal to the new one: P <- T P T^T. (R36)
inline void move_errors(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

/// Same for one error.
inline void move_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
