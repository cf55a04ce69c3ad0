// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// lost_heading.hpp prevents that the filter gains false information about the heading: rolling.md (R34) to (R36).
/// Rolling does not determine the heading: a rotation of the whole run about the vertical leaves all readings
/// unchanged. If the heading error is large, a linearised filter still reduces the heading's variance, because its
/// linearisation point changes.
namespace tumble::rolling {

/// The filter is corrected while the standard deviation of the heading exceeds kLostHeading_rad. The false information
/// about the heading grows with the square of this standard deviation.
inline constexpr double kLostHeading_rad = 0.1;

inline bool heading_lost(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Changes the derivative of the contact velocity so that a rotation of the whole run has no effect: rolling.md (R35).
/// A contact point at rest stays at rest in a rotated run.
inline void remove_heading_effect(Contact& c) {
  c.H.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.contact_velocity_W_m_s);
}

/// Returns how a correction `x` of the nominal trajectory changes the effect of a rotation about the vertical on the
/// error state: rolling.md (R36).
inline Vector heading_effect(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance P of the errors to the corrected nominal trajectory, P <- T P T^T: rolling.md (R36).
inline void move_errors(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

/// Transforms one error x from the old to the corrected nominal trajectory.
inline void move_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
