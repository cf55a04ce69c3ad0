// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// lost_heading.hpp prevents false information about the heading, which contact does not determine. The readings do not
/// change if a whole run is rotated about the vertical. A linearised filter with a large heading error still gains
/// false information, because the linearisation points of successive updates differ. See rolling.md (R34) to (R36).
namespace tumble::rolling {

/// Standard deviation of the heading above which the correction of lost_heading.hpp is applied. The false information
/// grows with the square of the standard deviation.
inline constexpr double kLostHeading_rad = 0.1;

inline bool heading_lost(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Removes the effect of a rotation of the whole run from the derivative of the contact velocity, rolling.md (R35). The
/// true effect is zero while the contact point does not move.
inline void remove_heading_effect(Contact& c) {
  c.H.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.contact_velocity_W_m_s);
}

/// Returns how a correction `x` of the nominal changes the effect of a rotation about the vertical on velocity,
/// position and slope, rolling.md (R36).
inline Vector heading_effect(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance P of errors about the old nominal to errors about the new nominal, P <- T P T^T,
/// rolling.md (R36).
inline void move_errors(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

/// Transforms one error about the old nominal to an error about the new nominal.
inline void move_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
