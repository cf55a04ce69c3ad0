// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Message definitions and types stored in ROS 2 bags. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// Converts "sensor_msgs/Imu" to ROS 2's "sensor_msgs/msg/Imu" and back.
std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

/// Returns the definition of a message (by ROS 1's name) with its nested messages, as rosbag2 stores them (encoding
/// "ros2msg"). Throws std::logic_error for messages that are never written.
std::string ros2_definition(const std::string& type);

/// Returns a topic's quality of service in the YAML of rosbag2's metadata: transient for /tf_static, for late
/// listeners; else empty (default).
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
