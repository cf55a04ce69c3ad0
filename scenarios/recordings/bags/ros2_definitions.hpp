// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// What ROS 2 says of its messages where a bag keeps it. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// "sensor_msgs/Imu" as ROS 2 calls it, "sensor_msgs/msg/Imu", and back.
std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

/// The definition of a message by ROS 1's name, with those of the messages inside of it, as rosbag2 stores them
/// (encoding "ros2msg"). Throws std::logic_error for a message that is not written here.
std::string ros2_definition(const std::string& type);

/// The quality of service under which a topic is offered again, in the YAML of rosbag2's metadata: of /tf_static kept
/// for listeners that come late; empty for others, which means the default.
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
