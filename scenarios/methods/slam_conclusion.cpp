// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/slam_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/methods/sweep_log.hpp"

namespace tumble::scenarios {

namespace {

void report_end(Estimate& estimate) {
  const Eigen::Matrix<double, 6, 6>& P = estimate.sweeps.back().pose.covariance;
  estimate.health["end_sigma_m"] = std::sqrt(P.topLeftCorner<3, 3>().trace());
  estimate.health["end_sigma_rad"] = std::sqrt(P.bottomRightCorner<3, 3>().trace());
}

Status any_registered(std::span<const SweepReport> sweeps) {
  const bool any = std::any_of(sweeps.begin(), sweeps.end(),
                               [](const SweepReport& sweep) { return sweep.verdict != SweepVerdict::rejected; });
  return any ? Status{} : Status{ErrorCode::insufficient_data, "lidar.sweeps_registered", 0.0, 1.0};
}

}  // namespace

void apply_smoothed(std::vector<PoseState> smoothed, SweepReport& sweep) {
  if (smoothed.empty()) return;
  sweep.trajectory = std::move(smoothed);
  sweep.pose = sweep.trajectory.back();
}

bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate) {
  for (const SweepReport& sweep : estimate.sweeps) append_poses(sweep.trajectory, estimate);
  if (!estimate.sweeps.empty()) report_end(estimate);
  const bool localised = !estimate.sweeps.empty() && report_localised(estimate);
  estimate.map = odometry.map();
  estimate.status = any_registered(estimate.sweeps);
  return localised && estimate.status.ok();
}

}  // namespace tumble::scenarios
