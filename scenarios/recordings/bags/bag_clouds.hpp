// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"

/// Converts point messages to columns. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// Returns true for a CustomMsg of a Livox driver, by ROS 1's name: livox_ros_driver, livox_ros_driver2 or
/// livox_interfaces, which have the same fields.
bool is_livox_type(const std::string& type);

/// Converts a cloud whose fields have one number each. Throws BadInput, with a message that starts with `where`: a
/// layout that does not fit the data, or big-endian numbers.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

/// Returns the columns x y z reflectivity tag line, and offset_time_ns since the header's stamp. Throws BadInput, with
/// a message that starts with `where`, if the number of points differs from the stated one.
Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// Returns a digest of all points: equal contents, equal digests. O(bytes).
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
