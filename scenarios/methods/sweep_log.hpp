// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/method.hpp"

/// What every chain over sweeps does with each of them: counted, told and put into the estimate.
namespace tumble::scenarios {

using SweepReport = LidarInertialOdometry::SweepReport;

/// Counts the trouble of a sweep, if any, as `sweeps_NAME` in the estimate's health.
void count_trouble(const Status& status, Estimate& estimate);

/// Counts the trouble and the verdict of a sweep that ends at `end_ns` and appends it. A covered lidar is a fact of
/// life: false, and the trouble is the estimate's, only where the sweep was not placed at all.
bool append_sweep(const Status& status, TimeNs end_ns, SweepReport report, Estimate& estimate);

/// Those that are later than the last: sweeps share the IMU's time at their border, and the earlier one has it.
void append_poses(std::span<const PoseState> trajectory, Estimate& estimate);

/// One that the IMU does not cover is counted, and left out.
void leave_out_unfinished(Estimate& estimate);

/// Counts the trouble of a sweep that has no pose because it came before the IMU or had too few points to start the
/// map. False for any other sweep.
bool leave_out_before_map(const Status& status, const SweepReport& report, Estimate& estimate);

/// A mapper as the loop over sweeps knows it.
struct SweepMapper {
  /// Whether the IMU covers the sweep. Trouble on the way is the estimate's, and ends the run.
  std::function<bool(const bridge::Sweep&)> covers;
  std::function<Status(const bridge::Sweep&, SweepReport&)> add;
};

/// Gives each sweep to the mapper, in order, and gathers their poses; `too_few` where none was registered. False where
/// trouble ended the run before the last.
bool run_over_sweeps(const sim::LidarRecord& lidar, const SweepMapper& mapper, Estimate& estimate);

}  // namespace tumble::scenarios
