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

}  // namespace tumble::scenarios
