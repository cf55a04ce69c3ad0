// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"

/// bag_clouds.hpp converts point messages to columns. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Returns true if `type` is the CustomMsg of a Livox driver, with its ROS 1 name. The types of livox_ros_driver,
/// livox_ros_driver2 and livox_interfaces have equal fields.
bool is_livox_type(const std::string& type);

/// Converts a cloud whose fields have one number each. Throws BadInput, with a message that starts with `where`, for
/// big-endian numbers or a layout that does not fit the data.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

/// Returns the columns x y z reflectivity tag line, and offset_time_ns since the header's stamp. Throws BadInput, with
/// a message that starts with `where`, if the number of points differs from the number that the message states.
Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// Returns a digest of all points. Clouds with equal contents have equal digests. O(bytes).
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
