// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_bytes.hpp"

namespace tumble::scenarios {

/// The member `type` has the form of ROS 1, for example "sensor_msgs/Imu", also for bags of ROS 2.
struct BagTopic {
  std::string name, type;
};

class BagWriter {
 public:
  virtual ~BagWriter() = default;
  /// Declares `topics` in the given order. Returns false if the bag format can declare a topic only with its first
  /// message.
  virtual bool begin_with(const std::vector<BagTopic>& topics) = 0;
  /// The caller must write messages in order of time, and each topic must have only one message type.
  virtual void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) = 0;
  /// The destructor removes an incomplete bag.
  virtual void finish() = 0;
};

class BagReader {
 public:
  virtual ~BagReader() = default;
  virtual std::vector<BagTopic> topics() = 0;
  /// `record_ns` is the record stamp of the message [ns since 1970].
  using Take = std::function<void(ros::Bytes&, std::int64_t record_ns)>;
  virtual void read(const std::string& topic, const Take& take) = 0;
  /// Returns true if the messages of a topic are encoded in CDR (ROS 2), and false for the encoding of ROS 1.
  virtual bool cdr(const std::string& topic) const = 0;

  std::vector<std::string> notes;  ///< remarks for the user
};

inline constexpr const char* kFilesSorted =
    "the metadata of the bag does not list the files by time; the import reads the files in the order of time";

std::unique_ptr<BagWriter> make_ros1_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_writer(const std::filesystem::path& folder);
std::unique_ptr<BagWriter> make_mcap_writer(const std::filesystem::path& file);
std::unique_ptr<BagWriter> make_ros2_mcap_writer(const std::filesystem::path& folder);
std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& path);
std::unique_ptr<BagReader> open_ros2_bag(const std::filesystem::path& path);
std::unique_ptr<BagReader> open_mcap(const std::vector<std::filesystem::path>& files);

/// Checks every length, position and offset in the ROS 1 bag against the file size, because librosbag does not check
/// these numbers.
void check_ros1_bag(const std::filesystem::path& file);

enum class PointQuantity { x_m, y_m, z_m, intensity, ring, time };

enum class NumberType { uint8, uint16, uint32, float32, float64 };

struct PointColumn {
  std::string name;
  PointQuantity quantity;
  NumberType type;
  double scale = 1.0;     ///< for time: units per ns
  bool absolute = false;  ///< since 1970, not the sweep's start
};

struct SweepLayout {
  /// Fields of a sensor_msgs/PointCloud2, in order and without gaps; time fields are omitted if the points have no
  /// times.
  std::vector<PointColumn> columns;
  bool livox = false;          ///< CustomMsg instead of `columns`
  bool in_time_order = false;  ///< true: points sorted by time
};

SweepLayout own_sweep_layout();
SweepLayout livox_sweep_layout();

struct ReaderNames {
  std::string imu_topic, imu_frame;
  std::string points_topic, lidar_frame;
  std::string body_frame;
  std::string fixed_frame;  ///< parent of the body; empty: none
};

}  // namespace tumble::scenarios
