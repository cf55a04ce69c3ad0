// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"

/// Points of messages as columns. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// Whether a type, by ROS 1's name, is the CustomMsg of one of Livox' drivers: livox_ros_driver, livox_ros_driver2
/// or livox_interfaces, whose fields are the same.
bool is_livox_type(const std::string& type);

/// Columns of a cloud, of fields of one number each. Throws BadInput beginning with `where`: a layout that does not fit
/// the message's data, big-endian numbers.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

/// Columns x y z reflectivity tag line, and offset_time_ns since the header's stamp. Throws BadInput beginning with
/// `where`: another number of points than the message states.
Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// A digest of all points: equal contents, equal digests. O(bytes).
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
