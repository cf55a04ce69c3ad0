// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "tumble/common/status.hpp"

namespace tumble::baselines {

inline Status check_attitude(const Eigen::Quaterniond& q_WI) {
  constexpr double kUnitTolerance = 1e-6;
  if (!q_WI.coeffs().allFinite()) return {ErrorCode::non_finite, "q_WI", q_WI.coeffs().sum(), 1.0};
  const double length = q_WI.coeffs().stableNorm();
  if (std::abs(length - 1.0) > kUnitTolerance) return {ErrorCode::out_of_range, "q_WI", length, 1.0};
  return {};
}

}  // namespace tumble::baselines
