// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tumble {

/// Returns the smallest rotation that turns the unit vector `up_W` to the z axis; the rotation keeps the heading. If
/// `up_W` is opposite to z, the result is a half turn about x.
inline Eigen::Quaterniond levelling(const Eigen::Vector3d& up_W) {
  const double w = std::sqrt(std::max(0.0, 0.5 * (1.0 + up_W.z())));
  if (w < 1e-6) return {0.0, 1.0, 0.0, 0.0};
  return Eigen::Quaterniond(w, 0.5 * up_W.y() / w, -0.5 * up_W.x() / w, 0.0).normalized();
}

}  // namespace tumble
