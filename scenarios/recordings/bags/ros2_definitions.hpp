// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// ros2_definitions.hpp returns the message types and definitions that ROS 2 bags store.
namespace tumble::scenarios {

/// Converts a type name such as "sensor_msgs/Imu" to ROS 2's "sensor_msgs/msg/Imu", or back.
std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

/// Returns the definition of a message type (by its ROS 1 name) and of its nested messages, in the form of rosbag2
/// (encoding "ros2msg"). Throws std::logic_error for types that the bag writers never write.
std::string ros2_definition(const std::string& type);

/// Returns the quality of service of a topic as YAML for rosbag2's metadata. For /tf_static it is transient, so that
/// new subscribers receive the transforms. For other topics, the text is empty, which means the default.
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
