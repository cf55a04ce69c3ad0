// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"

namespace tumble::scenarios {

/// The messages of livox_ros_driver, livox_ros_driver2 and livox_interfaces have the same fields.
bool is_livox_type(const std::string& type);

Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// Point clouds with equal digests are duplicate messages.
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
