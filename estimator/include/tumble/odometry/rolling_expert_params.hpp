// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble {

struct MergedRecordings;

/// RollingOdometryExpertParams contains the rarely changed parameters of RollingOdometry. If RollingOdometry::Params
/// contains the same parameter, RollingOdometry uses the value in RollingOdometry::Params.
struct RollingOdometryExpertParams {
  ImuMerge::Params merge;
  RollingSmoother::Params rolling;
  SampleClock::Params stamps;  ///< correction of time stamps that a host computer assigned

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("merge_", p.merge);
    visit.group("rolling_", p.rolling);
    visit.group("stamps_", p.stamps);
  }
};

/// Returns the parameters with which RollingSmoother processes merged readings, for programs that use RollingSmoother
/// alone.
RollingSmoother::Params rolling_smoother_params(const RollingOdometry::Params& params, const MergedRecordings& merged);

}  // namespace tumble
