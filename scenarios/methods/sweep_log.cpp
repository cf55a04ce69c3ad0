// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sweep_log.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tumble::scenarios {

namespace {

Status any_registered(std::span<const SweepResult> sweeps) {
  const bool any = std::any_of(sweeps.begin(), sweeps.end(),
                               [](const SweepResult& sweep) { return sweep.verdict != SweepVerdict::rejected; });
  return any ? Status{} : Status{ErrorCode::insufficient_data, "lidar.sweeps_registered", 0.0, 1.0};
}

}  // namespace

void count_trouble(const Status& status, Estimate& estimate) {
  if (!status.ok()) estimate.health[std::string("sweeps_") + to_string(status.error_code)] += 1.0;
}

bool append_sweep(const Status& status, TimeNs end_ns, SweepResult report, Estimate& estimate) {
  if (!status.ok() && report.trajectory.empty()) {
    estimate.status = status;
    return false;
  }
  count_trouble(status, estimate);
  estimate.health[std::string("sweeps_") + to_string(report.verdict)] += 1.0;
  estimate.sweep_end_ns.push_back(end_ns);
  estimate.sweeps.push_back(std::move(report));
  return true;
}

void append_poses(std::span<const PoseState> trajectory, Estimate& estimate) {
  for (const PoseState& pose : trajectory) {
    if (estimate.poses.empty() || pose.time_ns > estimate.poses.back().time_ns) estimate.poses.push_back(pose);
  }
}

void leave_out_unfinished(Estimate& estimate) {
  estimate.health["sweeps_unfinished"] += 1.0;
}

bool leave_out_before_map(const Status& status, const SweepResult& report, Estimate& estimate) {
  const bool of_the_sweep = status.error_code == ErrorCode::insufficient_data ||
                            status.error_code == ErrorCode::empty || status.error_code == ErrorCode::non_finite ||
                            status.error_code == ErrorCode::degenerate;
  if (!of_the_sweep || !report.trajectory.empty() || !estimate.sweeps.empty()) return false;
  count_trouble(status, estimate);
  return true;
}

bool run_over_sweeps(const sim::LidarRecord& lidar, const SweepMapper& mapper, Estimate& estimate) {
  const std::size_t sweeps = bridge::sweep_count(lidar);
  for (std::size_t k = 0; k < sweeps; ++k) {
    const bridge::Sweep sweep = bridge::sweep(lidar, k);
    const bool covered = mapper.covers(sweep);
    if (!estimate.status.ok()) return false;
    if (!covered) {
      leave_out_unfinished(estimate);
      continue;
    }
    SweepResult report;
    const Status status = mapper.add(sweep, report);
    if (leave_out_before_map(status, report, estimate)) continue;
    if (!append_sweep(status, sweep.end_ns, std::move(report), estimate)) return false;
    append_poses(estimate.sweeps.back().trajectory, estimate);
  }
  if (const Status status = any_registered(estimate.sweeps); !status.ok()) estimate.status = status;
  return true;
}

namespace {

void report_end(Estimate& estimate) {
  const Eigen::Matrix<double, 6, 6>& P = estimate.sweeps.back().pose.covariance;
  estimate.health["end_sigma_m"] = std::sqrt(P.topLeftCorner<3, 3>().trace());
  estimate.health["end_sigma_rad"] = std::sqrt(P.bottomRightCorner<3, 3>().trace());
}

}  // namespace

void apply_smoothed(std::vector<PoseState> smoothed, SweepResult& sweep) {
  if (smoothed.empty()) return;
  sweep.trajectory = std::move(smoothed);
  sweep.pose = sweep.trajectory.back();
}

bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate) {
  for (const SweepResult& sweep : estimate.sweeps) append_poses(sweep.trajectory, estimate);
  if (!estimate.sweeps.empty()) report_end(estimate);
  const bool consistent = !estimate.sweeps.empty() && has_consistent_poses(estimate);
  estimate.map = odometry.map();
  estimate.status = any_registered(estimate.sweeps);
  return consistent && estimate.status.ok();
}

}  // namespace tumble::scenarios
