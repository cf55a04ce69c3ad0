// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thrown_body.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::test {

/// Parameters of TumblingOdometry for the thrown body.
inline TumblingOdometry::Params params_of(const ThrownBody& body) {
  TumblingOdometry::Params params;
  params.imu.rate_hz = body.imu_hz;
  params.lever_arm_I_m = body.lever_arm_I_m;
  return params;
}

}  // namespace tumble::test
