// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// What no contact tells: the heading. A sphere whose run is turned about the vertical as a whole reads the same. A
/// linear filter that is far off in heading learns of it all the same, from one update to the next, since each takes
/// its derivatives elsewhere: rolling.md (R37) to (R39).
namespace tumble::rolling {

/// From this deviation of the heading on; below, what is learnt by mistake is of its square.
inline constexpr double kLostHeading_rad = 0.1;

inline bool lost_heading(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Takes out of the derivative of the contact velocity what a turn of the whole run makes of it: nothing, where the
/// contact stands still. (R38)
inline void blind_to_heading(Contact& c) {
  c.H.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.u_W_m_s);
}

/// What a turn of the whole run about the vertical adds to velocity, position and slope beyond what it did before the
/// nominal was moved by `x`. (R39)
inline Vector turned_by_heading(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Errors about the nominal before it was moved, as errors about that after: P <- T P T^T. (R39)
inline void move_errors(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

/// The same of one error.
inline void move_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
