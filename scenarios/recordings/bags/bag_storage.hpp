// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_bytes.hpp"

/// The kinds of bags behind one face: topics, and messages as bytes in order of time. Private to
/// scenarios/recordings/bags.
namespace tumble::scenarios {

/// Types by ROS 1's names ("sensor_msgs/Imu"); ROS 2 has "sensor_msgs/msg/Imu".
struct BagTopic {
  std::string name, type;
};

class BagWriter {
 public:
  virtual ~BagWriter() = default;
  /// Has the bag name these topics before others, in this order. False: bags of this kind name them in the order of
  /// their first messages, which may then come before their time.
  virtual bool begin_with(const std::vector<BagTopic>& topics) = 0;
  /// Messages must come in order of time, those of a topic all of one type. Throws BadInput.
  virtual void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) = 0;
  /// Nothing is left of a bag that was not finished. Throws BadInput.
  virtual void finish() = 0;
};

class BagReader {
 public:
  virtual ~BagReader() = default;
  virtual std::vector<BagTopic> topics() = 0;
  /// Takes a message and when it was recorded, ns since 1970.
  using Take = std::function<void(ros::Bytes&, std::int64_t record_ns)>;
  /// Calls `take` for each message of the topic in the order in which they were recorded. Throws BadInput.
  virtual void read(const std::string& topic, const Take& take) = 0;
  /// The topic's messages are CDR, else ROS 1's layout.
  virtual bool cdr(const std::string& topic) const = 0;
};

std::unique_ptr<BagWriter> make_ros1_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_writer(const std::filesystem::path& folder);
std::unique_ptr<BagWriter> make_mcap_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_mcap_writer(const std::filesystem::path& folder);
std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& file);
std::unique_ptr<BagReader> open_ros2_bag(const std::filesystem::path& path);
/// Files that are one bag, in order.
std::unique_ptr<BagReader> open_mcap(const std::vector<std::filesystem::path>& files);

/// Walks the records of a ROS 1 bag and holds every length, position and offset in them against the file, since the
/// library trusts them; what is inside compressed chunks is left to it. Throws BadInput with the offset in the file.
void check_ros1_bag(const std::filesystem::path& file);

}  // namespace tumble::scenarios
