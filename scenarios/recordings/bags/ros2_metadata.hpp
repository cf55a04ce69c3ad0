// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

namespace tumble::scenarios {

/// What the metadata.yaml of a ROS 2 bag says of it. Private to scenarios/recordings/bags.
struct Ros2Summary {
  struct Topic {
    BagTopic topic;
    std::int64_t messages = 0;
  };
  std::string storage;  ///< "sqlite3" or "mcap"
  std::string file;     ///< its name in the folder
  std::vector<Topic> topics = {};
  std::int64_t first_ns = 0, last_ns = 0;  ///< of the messages' stamps

  /// Of a topic, the last one when it is new.
  std::size_t place_of(const BagTopic& topic);
  /// Takes note of a message.
  void count(const BagTopic& topic, std::int64_t stamp_ns);
};

/// The text of metadata.yaml, version 5.
std::string ros2_metadata(const Ros2Summary& bag);

}  // namespace tumble::scenarios
