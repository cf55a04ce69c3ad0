// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

ros::Message sweep_message(const sim::LidarRecord& lidar, std::size_t sweep, const SweepLayout& layout,
                           std::int64_t start_ns, const ros::Header& header);

}  // namespace tumble::scenarios
