// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

namespace tumble::scenarios {

struct Ros2Summary {
  struct Topic {
    BagTopic topic;
    std::int64_t messages = 0;
  };
  std::string storage;  ///< "sqlite3" or "mcap"
  std::string file;     ///< file name in the folder
  std::vector<Topic> topics = {};
  std::int64_t first_ns = 0, last_ns = 0;

  std::size_t place_of(const BagTopic& topic);
  void count(const BagTopic& topic, std::int64_t stamp_ns);
};

std::string ros2_metadata(const Ros2Summary& bag);

std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

std::string ros2_definition(const std::string& type);

/// Returns the quality of service of a topic as YAML for rosbag2. The topic /tf_static is transient local, so that new
/// subscribers receive the transforms.
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
