// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/rolling/rolling_truth.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::testing {

/// Returns parameters of the smoother for the sphere of rolling_truth.hpp.
inline RollingSmoother::Params lagged_params(double lag_s) {
  RollingSmoother::Params out;
  out.filter.radius_m = kRadius_m;
  out.filter.lever_arm_m = kLeverArm;
  out.lag_s = lag_s;
  return out;
}

}  // namespace tumble::testing
