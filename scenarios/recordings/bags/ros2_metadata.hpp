// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

namespace tumble::scenarios {

/// Ros2Summary contains the data for the metadata.yaml of a ROS 2 bag.
struct Ros2Summary {
  struct Topic {
    BagTopic topic;
    std::int64_t messages = 0;
  };
  std::string storage;  ///< "sqlite3" or "mcap"
  std::string file;     ///< file name in the folder
  std::vector<Topic> topics = {};
  std::int64_t first_ns = 0, last_ns = 0;  ///< smallest and largest time stamp

  /// Returns the index of a topic in the list, after appending a new topic.
  std::size_t place_of(const BagTopic& topic);
  /// Counts a message of a topic, and extends the time range of the bag to its stamp.
  void count(const BagTopic& topic, std::int64_t stamp_ns);
};

/// Returns the text of metadata.yaml, version 5.
std::string ros2_metadata(const Ros2Summary& bag);

}  // namespace tumble::scenarios
