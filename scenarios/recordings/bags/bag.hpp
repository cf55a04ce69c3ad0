// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// How a recording is written as a bag.
struct BagWriting {
  std::int64_t origin_ns = 0;         ///< stamp of time 0; 0: 1 000 000 000 s after 1970, since ROS takes 0 for no time
  const sim::Truth* truth = nullptr;  ///< written only when given
};

/// Writes a recording as a ROS 1 bag (version 2.0, by librosbag), or as a ROS 2 bag: a folder with metadata.yaml
/// (version 5) and a SQLite file of CDR messages. Topics: "/NAME" (sensor_msgs/Imu; without attitude; white noise of
/// the data sheet as covariance), "/NAME/points" (sensor_msgs/PointCloud2, stamped at the sweep's start, with the
/// fields that drivers of Velodyne give: x y z intensity ring time, the time float32 seconds after the stamp, to 4 ns
/// within 0.1 s; no time where points have none), and "/truth" (nav_msgs/Odometry of the body in "world", every 5 ms at
/// most). NAME is the sensor's. Throws BadInput when the place cannot be written.
void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);

/// What is taken from a bag.
struct BagReading {
  std::vector<std::string> imu_topics;    ///< the first is the primary one; empty: all of type Imu, as they stand
  std::vector<std::string> lidar_topics;  ///< empty: all of type PointCloud2
  std::string reference_topic;            ///< Odometry or PoseStamped; "": none
  bool reference_of_body = true;          ///< else of the first lidar
  sim::ImuRecord imu;                     ///< what the messages do not state: device, ranges, noise, T_BI
  AccelUnit accel_unit = AccelUnit::m_s2;
  SweepReading sweeps;
};

/// Reads a ROS 1 bag (not encrypted), or a ROS 2 bag: its folder, or its SQLite file. Times are those of the messages'
/// headers. Sensors bear the name of their topic. Points as import_sweeps takes them. Throws BadInput with file and
/// place: damaged, truncated, a topic that is not there or of another type, a message whose stamp does not rise.
Imported import_ros1_bag(const std::filesystem::path& file, const BagReading& reading);
Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading);

}  // namespace tumble::scenarios
