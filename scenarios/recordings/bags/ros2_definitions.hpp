// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Returns the message definitions and types stored in ROS 2 bags. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// These functions convert a type name such as "sensor_msgs/Imu" to ROS 2's "sensor_msgs/msg/Imu" and back.
std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

/// Returns the definition of a message (by its ROS 1 name) with nested messages, as rosbag2 stores definitions
/// (encoding "ros2msg"). Throws std::logic_error for message types that the bag writers never write.
std::string ros2_definition(const std::string& type);

/// Returns a topic's quality of service in the YAML of rosbag2's metadata. /tf_static is transient, so that late
/// listeners receive the transforms. For other topics, the text is empty (default).
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
