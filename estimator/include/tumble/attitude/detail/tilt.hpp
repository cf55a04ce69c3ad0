// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/common/types.hpp"

namespace tumble {

/// Returns the smallest rotation that turns the unit vector `up_W` to the z axis; the rotation keeps the heading. If
/// `up_W` is opposite to z, the result is a half turn about x.
inline Eigen::Quaterniond levelling(const Eigen::Vector3d& up_W) {
  const double w = std::sqrt(std::max(0.0, 0.5 * (1.0 + up_W.z())));
  if (w < 1e-6) return {0.0, 1.0, 0.0, 0.0};
  return Eigen::Quaterniond(w, 0.5 * up_W.y() / w, -0.5 * up_W.x() / w, 0.0).normalized();
}

/// Returns the rotation about the axis of levelling(up_W) by `share` times its angle, with `share` in [0, 1].
inline Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& up_W, double share) {
  const double across = std::hypot(up_W.x(), up_W.y());
  const double angle = share * std::atan2(across, up_W.z());
  if (across < 1e-12) return so3::exp({angle, 0.0, 0.0});
  return so3::exp(angle / across * Eigen::Vector3d(up_W.y(), -up_W.x(), 0.0));
}

}  // namespace tumble
