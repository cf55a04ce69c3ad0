// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/left_out.hpp"

namespace tumble::scenarios {

struct CloudHeaders {
  std::vector<std::int64_t> stamps;  ///< sweep starts, in order
  std::int64_t period_ns = 0;        ///< from the user, or median step
  /// Start of the sweep in each message; empty for duplicate and skipped messages.
  std::vector<std::optional<std::int64_t>> starts;
  LeftOut left_out{"clouds"};
  std::string remark;
  bool follow_records = true;      ///< record stamps are later, same clock
  std::int64_t record_lag_ns = 0;  ///< smallest delay from header stamp to record stamp
  std::string frame;
  bool left_out_as_map(const BagReading& reading) const {
    return reading.lidar_topics.empty() && (frame == "world" || frame == "map" || frame == "odom");
  }
};

CloudHeaders read_headers(const OpenedBag& bag, const std::string& topic, const BagReading& reading);

BuiltSweeps read_lidar(const OpenedBag& bag, SensorMountings& places, const std::string& topic,
                       const CloudHeaders& headers, const BagReading& reading, std::vector<std::string>& notes);

/// Returns true for the message types of livox_ros_driver, livox_ros_driver2 and livox_interfaces, which have the same
/// fields.
bool is_livox_type(const std::string& type);

Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// Returns a digest (hash) of a point cloud. Two messages whose point clouds have equal digests are duplicates.
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
