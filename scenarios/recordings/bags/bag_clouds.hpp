// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/ros_messages.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"

/// The functions in bag_clouds.hpp convert point messages to columns.
namespace tumble::scenarios {

/// Returns true if `type` is the CustomMsg of a Livox driver, by its ROS 1 name. The types of livox_ros_driver,
/// livox_ros_driver2 and livox_interfaces have the same fields.
bool is_livox_type(const std::string& type);

/// Converts a PointCloud2 message to columns. Each field must contain one number per point. Throws BadInput, with a
/// message that starts with `where`, for big-endian numbers or a layout that contradicts the size of the data.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where);

/// Converts a CustomMsg to the columns x y z reflectivity tag line, and offset_time_ns since the header's stamp. If the
/// number of points differs from that in the header, throws BadInput with a message that starts with `where`.
Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where);

/// Returns a digest of the points of a message, to find duplicates. The cost is proportional to the number of bytes.
std::uint64_t content_of(const ros::PointCloud2& message);
std::uint64_t content_of(const ros::LivoxCustomMsg& message);

}  // namespace tumble::scenarios
