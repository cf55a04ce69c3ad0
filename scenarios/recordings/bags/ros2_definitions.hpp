// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

std::string ros2_type(const std::string& type);
std::string ros1_type(std::string type);

std::string ros2_definition(const std::string& type);

/// Quality of service of a topic as YAML for rosbag2; /tf_static is transient local, so that new subscribers receive
/// the transforms.
std::string ros2_qos(const std::string& topic);

}  // namespace tumble::scenarios
