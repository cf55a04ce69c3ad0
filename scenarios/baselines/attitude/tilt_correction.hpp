// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// Returns the fraction `share`, in [0, 1], of the smallest rotation that turns the unit vector `up_W` to the z axis
/// (docs/maths/attitude.md, equation (A2)).
inline Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& up_W, double share) {
  const double across = std::hypot(up_W.x(), up_W.y());
  const double angle = share * std::atan2(across, up_W.z());
  if (across < 1e-12) return so3::exp({angle, 0.0, 0.0});
  return so3::exp(angle / across * Eigen::Vector3d(up_W.y(), -up_W.x(), 0.0));
}

}  // namespace tumble::baselines
