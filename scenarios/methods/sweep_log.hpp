// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/method.hpp"

/// sweep_log.hpp contains counts, reports and results per sweep, which all slam chains share.
namespace tumble::scenarios {

using SweepReport = LidarInertialOdometry::SweepReport;

/// Counts the error of a sweep, if any, as `sweeps_NAME` in the estimate's health.
void count_trouble(const Status& status, Estimate& estimate);

/// Counts the error and verdict of the sweep that ends at `end_ns`, and appends the sweep to the estimate. Returns
/// false only if the sweep has no pose; the estimate's status is then the error. A sweep without returns is not an
/// error.
bool append_sweep(const Status& status, TimeNs end_ns, SweepReport report, Estimate& estimate);

/// Appends the poses that are later than the estimate's last pose. Consecutive sweeps share the IMU sample at their
/// boundary; the earlier sweep supplies the pose of this sample.
void append_poses(std::span<const PoseState> trajectory, Estimate& estimate);

/// Counts a sweep that extends beyond the IMU readings and is dropped.
void leave_out_unfinished(Estimate& estimate);

/// Counts the error of a sweep without a pose, which came before the IMU readings or had too few points to start the
/// map. Returns false for any other sweep.
bool leave_out_before_map(const Status& status, const SweepReport& report, Estimate& estimate);

/// SweepMapper is the interface of a mapper for the loop over sweeps.
struct SweepMapper {
  /// `covers` returns whether the IMU covers the sweep. `add` adds the sweep; an error becomes the estimate's status
  /// and ends the run.
  std::function<bool(const bridge::Sweep&)> covers;
  std::function<Status(const bridge::Sweep&, SweepReport&)> add;
};

/// Processes all sweeps in order and collects their poses. The status is `too_few` if no sweep was registered. Returns
/// false if an error ended the run early.
bool run_over_sweeps(const sim::LidarRecord& lidar, const SweepMapper& mapper, Estimate& estimate);

}  // namespace tumble::scenarios
