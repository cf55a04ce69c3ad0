// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/bridge.hpp"

namespace tumble::scenarios {

using SweepResult = LidarInertialOdometry::SweepResult;

void count_trouble(const Status& status, Estimate& estimate);

/// Appends the report of a sweep to an estimate. Returns false if the sweep has no pose, and copies the error `status`
/// of the sweep to `estimate.status`.
bool append_sweep(const Status& status, TimeNs end_ns, SweepResult report, Estimate& estimate);

/// Consecutive sweeps share the IMU sample at their boundary, so the pose at this sample comes from the earlier sweep.
void append_poses(std::span<const PoseState> trajectory, Estimate& estimate);

void leave_out_unfinished(Estimate& estimate);

/// A lidar sweep before the first IMU reading, or with too few points to start the map, gets no pose.
bool leave_out_before_map(const Status& status, const SweepResult& report, Estimate& estimate);

struct SweepMapper {
  std::function<bool(const bridge::Sweep&)> covers;
  std::function<Status(const bridge::Sweep&, SweepResult&)> add;
};

bool run_over_sweeps(const sim::LidarRecord& lidar, const SweepMapper& mapper, Estimate& estimate);

void apply_smoothed(std::vector<PoseState> smoothed, SweepResult& sweep);

/// Returns true if the run is complete and the final pose in the map is plausible.
bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate);

}  // namespace tumble::scenarios
