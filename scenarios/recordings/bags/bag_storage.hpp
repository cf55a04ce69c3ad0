// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_bytes.hpp"

/// bag_storage.hpp defines the common interface of all bag types. A bag has topics, and messages as bytes sorted by
/// time. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// BagTopic is a topic with its message type. Type names are those of ROS 1 ("sensor_msgs/Imu"); ROS 2 uses
/// "sensor_msgs/msg/Imu".
struct BagTopic {
  std::string name, type;
};

class BagWriter {
 public:
  virtual ~BagWriter() = default;
  /// Registers these topics before all other topics, in order. Returns false if this bag type registers topics with
  /// their first messages. A bag of this type may contain other topics earlier.
  virtual bool begin_with(const std::vector<BagTopic>& topics) = 0;
  /// Writes a message. Messages must be sorted by time, and each topic has one message type. Throws BadInput.
  virtual void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) = 0;
  /// Completes the bag. An unfinished bag is removed. Throws BadInput.
  virtual void finish() = 0;
};

class BagReader {
 public:
  virtual ~BagReader() = default;
  virtual std::vector<BagTopic> topics() = 0;
  /// Take receives a message and the time of its record [ns since 1970].
  using Take = std::function<void(ros::Bytes&, std::int64_t record_ns)>;
  /// Calls `take` for each message of the topic in recorded order. Throws BadInput.
  virtual void read(const std::string& topic, const Take& take) = 0;
  /// Returns whether the topic's messages have CDR encoding instead of ROS 1's layout.
  virtual bool cdr(const std::string& topic) const = 0;

  std::vector<std::string> notes;  ///< for the user, for example on files that the bag's metadata does not list
};

/// kFilesSorted is a note for the user on a bag of several files.
inline constexpr const char* kFilesSorted =
    "the bag does not list its files in the order of time; the import reads the files in the order of time";

std::unique_ptr<BagWriter> make_ros1_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_writer(const std::filesystem::path& folder);
std::unique_ptr<BagWriter> make_mcap_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_mcap_writer(const std::filesystem::path& folder);
/// Opens a file, or a folder of files that are parts of one recording. The messages of the files are merged by time.
std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& path);
std::unique_ptr<BagReader> open_ros2_bag(const std::filesystem::path& path);
/// Opens several files that form one bag. The files are read in the order of their first messages.
std::unique_ptr<BagReader> open_mcap(const std::vector<std::filesystem::path>& files);

/// Checks every length, position and offset in the records of a ROS 1 bag against the file size, because librosbag does
/// not. librosbag checks the content of compressed chunks. Throws BadInput with the offset in the file.
void check_ros1_bag(const std::filesystem::path& file);

}  // namespace tumble::scenarios
