// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {

/// Returns the synthetic recording, which is generated once.
inline const sim::Recording& rig() {
  static const sim::Recording recording = testing::synthetic_rig();
  return recording;
}

namespace testing {

/// Returns an estimate that is the truth: rates at the samples, attitudes and poses of `frame` at IMU times, sweeps
/// within the truth, and a map of the true hits.
inline Estimate perfect_estimate(const sim::Recording& recording, Frame frame = Frame::imu) {
  Estimate estimate;
  estimate.frame = frame;
  const TruthTrack truth(recording.truth, frame);
  const sim::ImuRecord& imu = recording.sensors.imus.front();
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    AngularRateState rate;
    rate.time_ns = imu.time_ns[k];
    rate.w_WI_I_rad_s = recording.truth.imus.front().rate_rad_s[k];
    rate.covariance_rad2_s2 = 1e-6 * Eigen::Matrix3d::Identity();
    estimate.rates.push_back(rate);
    const PoseState pose = truth.pose(imu.time_ns[k]);
    estimate.attitudes.push_back({pose.time_ns, pose.orientation_W, Eigen::Matrix3d::Zero()});
    estimate.poses.push_back(pose);
  }
  if (recording.sensors.lidars.empty()) return estimate;
  const sim::LidarRecord& lidar = recording.sensors.lidars.front();
  for (std::size_t k = 0; k < lidar.sweep_start_ns.size(); ++k) {
    LidarInertialOdometry::SweepResult sweep;
    sweep.verdict = k == 0 ? SweepVerdict::first : SweepVerdict::registered;
    const std::int64_t end_ns = lidar.sweep_start_ns[k] + lidar.sweep_period_ns;
    for (const PoseState& pose : estimate.poses) {
      if (pose.time_ns > lidar.sweep_start_ns[k] && pose.time_ns <= end_ns) sweep.trajectory.push_back(pose);
    }
    sweep.pose = truth.pose(end_ns);
    estimate.sweeps.push_back(sweep);
    estimate.sweep_end_ns.push_back(end_ns);
  }
  for (const Vector3f& hit : recording.truth.lidars.front().hit_W_m) {
    MapPoint point;
    point.position_W_m = hit;
    estimate.map.push_back(point);
  }
  return estimate;
}

/// Moves and turns the whole estimate by `T`, so that it has another world frame.
inline void move_world(const Isometry3d& T, Estimate& estimate) {
  const Quaterniond q(T.linear());
  const auto move = [&](PoseState& pose) {
    pose.position_W_m = T * pose.position_W_m;
    pose.orientation_W = q * pose.orientation_W;
    pose.velocity_W_m_s = q * pose.velocity_W_m_s;
  };
  for (AttitudeState& attitude : estimate.attitudes) attitude.orientation_W = q * attitude.orientation_W;
  for (PoseState& pose : estimate.poses) move(pose);
  for (auto& sweep : estimate.sweeps) {
    move(sweep.pose);
    for (PoseState& pose : sweep.trajectory) move(pose);
  }
  for (MapPoint& point : estimate.map) point.position_W_m = (T * point.position_W_m.cast<double>()).cast<float>();
}

inline std::map<std::string, double> scores(Kind kind, const Estimate& estimate, const sim::Recording& recording,
                                            const sim::Surface* surface = nullptr) {
  std::map<std::string, double> values;
  for (const Score& one : score(kind, {estimate, {&recording.sensors, &recording.truth, surface}})) {
    values[one.metric] = one.value;
  }
  return values;
}

inline OutcomeStatus verdict_of(Kind kind, const Estimate& estimate, const sim::Recording& recording) {
  return verdict(kind, {estimate, {&recording.sensors, &recording.truth, nullptr}});
}

}  // namespace testing
}  // namespace tumble::scenarios
