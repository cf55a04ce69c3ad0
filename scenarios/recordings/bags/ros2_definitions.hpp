// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// Converts "sensor_msgs/Imu" to ROS 2's "sensor_msgs/msg/Imu", or back.
std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

/// Returns the definition of a message type (by its ROS 1 name) and of its nested messages, in rosbag2's encoding
/// "ros2msg". Throws std::logic_error for types that the bag writers never write.
std::string ros2_definition(const std::string& type);

/// Returns the quality of service of a topic as YAML for rosbag2's metadata; empty means the default. /tf_static is
/// transient local, so that new subscribers receive the transforms.
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
