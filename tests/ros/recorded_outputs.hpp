// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "tumble_ros/publisher.hpp"

namespace tumble::test {

/// RecordedOutputs is a publisher that keeps every message.
struct RecordedOutputs : ros::Publisher {
  std::vector<ros::Odometry> sweeps, newest, in_position_frame;
  std::vector<ros::RecoveredImu> rates;
  std::vector<ros::DeskewedSweep> deskewed;
  std::vector<std::pair<TimeNs, std::size_t>> maps;  ///< stamp, number of points
  std::vector<std::pair<TimeNs, ros::Diagnostics>> health;
  bool wanted = true;

  bool wants(ros::Output) override { return wanted; }
  void odometry(const ros::Odometry& odometry) override { sweeps.push_back(odometry); }
  void odometry_imu(const ros::Odometry& odometry) override { newest.push_back(odometry); }
  void position_pose(const ros::Odometry& odometry) override { in_position_frame.push_back(odometry); }
  void imu(const ros::RecoveredImu& imu) override { rates.push_back(imu); }
  void points(const ros::DeskewedSweep& sweep) override { deskewed.push_back(sweep); }
  void map(TimeNs stamp_ns, const std::vector<MapPoint>& map) override { maps.emplace_back(stamp_ns, map.size()); }
  void diagnostics(TimeNs stamp_ns, const ros::Diagnostics& now) override { health.emplace_back(stamp_ns, now); }
};

}  // namespace tumble::test
