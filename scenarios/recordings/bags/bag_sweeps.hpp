// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/left_out.hpp"

/// bag_sweeps.hpp reads the point cloud topics of a bag.
namespace tumble::scenarios {

/// CloudHeaders contains the stamps and the frame of a topic's clouds, from a first pass without points.
struct CloudHeaders {
  std::vector<std::int64_t> stamps;  ///< sweep starts, in order
  std::int64_t period_ns = 0;        ///< period from the user, or the median step of the stamps
  /// Start of the sweep in each message; empty for duplicate and skipped messages.
  std::vector<std::optional<std::int64_t>> starts;
  LeftOut left_out{"clouds"};
  std::string remark;
  bool follow_records = true;  ///< records seem to use the headers' clock and are later than the stamps
  std::string frame;
  /// Returns true if the caller did not choose the topic and its frame belongs to no sensor: a map, or transformed
  /// points.
  bool left_out_as_map(const BagReading& reading) const {
    return reading.lidar_topics.empty() && (frame == "world" || frame == "map" || frame == "odom");
  }
};

/// Reads the stamps and the frame of a topic of clouds, and finds duplicate messages.
CloudHeaders read_headers(const OpenedBag& bag, const std::string& topic, const BagReading& reading);

/// Reads the points of a lidar topic. Single faulty clouds are skipped with a note.
BuiltSweeps read_lidar(const OpenedBag& bag, SensorMountings& places, const std::string& topic,
                       const CloudHeaders& headers, const BagReading& reading, std::vector<std::string>& notes);

}  // namespace tumble::scenarios
