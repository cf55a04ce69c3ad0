// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// Rolling does not determine the heading, because a rotation of the whole run about the vertical leaves all readings
/// unchanged. If the heading error is large, a linearised filter nevertheless reduces the heading's variance, which is
/// wrong: rolling.md (R34) to (R36).
namespace tumble::rolling {

/// standard deviation of the heading, above which a measurement must not reduce the variance of the heading
inline constexpr double kLostHeading_rad = 0.1;

inline bool heading_lost(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Removes the derivative of the contact velocity with respect to the heading error: rolling.md (R35).
inline void remove_heading_component(Contact& c) {
  c.measurement_jacobian.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.contact_velocity_W_m_s);
}

/// See rolling.md (R36).
inline Vector heading_component(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance P of the error state after a correction of the nominal trajectory, with the matrix T of
/// rolling.md (R36).
inline void remove_heading_covariance(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

inline void remove_heading_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
