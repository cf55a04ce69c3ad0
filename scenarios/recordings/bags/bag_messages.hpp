// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"

namespace tumble::scenarios {

ros::Header header_of(std::int64_t stamp_ns, const std::string& frame);
ros::Clock clock_message(std::int64_t stamp_ns);

ros::Imu imu_message(const sim::ImuRecord& imu, std::size_t i, const ros::Header& header);

ros::PointCloud2 cloud_message(const BagCloud& cloud, const ros::Header& header);

ros::Odometry odometry_message(const BagTrack::Pose& pose, const std::string& child, const ros::Header& header);
ros::TransformStamped transform_message(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, const std::string& child,
                                        const ros::Header& header);

}  // namespace tumble::scenarios
