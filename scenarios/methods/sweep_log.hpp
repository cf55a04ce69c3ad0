// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/method.hpp"

/// sweep_log.hpp stores the result of each sweep in an estimate, for all slam methods.
namespace tumble::scenarios {

using SweepReport = LidarInertialOdometry::SweepReport;

/// If `status` is an error, counts the sweep as `sweeps_NAME` in the health.
void count_trouble(const Status& status, Estimate& estimate);

/// Counts the error and verdict of the sweep that ends at `end_ns`, and appends the sweep to the estimate. A sweep
/// without points is not an error. Returns false if the sweep has no pose; its error is then the status of the
/// estimate.
bool append_sweep(const Status& status, TimeNs end_ns, SweepReport report, Estimate& estimate);

/// Appends the poses of the trajectory that are later than the last pose of the estimate. Consecutive sweeps share the
/// IMU sample at their boundary; the pose of this sample comes from the earlier sweep.
void append_poses(std::span<const PoseState> trajectory, Estimate& estimate);

/// Counts a sweep that is dropped because it ends after the IMU readings.
void leave_out_unfinished(Estimate& estimate);

/// Counts the error of a sweep without a pose: a sweep before the first IMU reading, or with too few points to start
/// the map. Returns false for other sweeps.
bool leave_out_before_map(const Status& status, const SweepReport& report, Estimate& estimate);

/// SweepMapper contains the two functions of a mapper that run_over_sweeps calls.
struct SweepMapper {
  /// `covers` returns true if the IMU readings cover the sweep. `add` adds the sweep to the map; an error ends the run
  /// and becomes the status of the estimate.
  std::function<bool(const bridge::Sweep&)> covers;
  std::function<Status(const bridge::Sweep&, SweepReport&)> add;
};

/// Passes all sweeps to the mapper in order and collects their poses. The status is `too_few` if no sweep was
/// registered. Returns false if an error ended the run early.
bool run_over_sweeps(const sim::LidarRecord& lidar, const SweepMapper& mapper, Estimate& estimate);

}  // namespace tumble::scenarios
