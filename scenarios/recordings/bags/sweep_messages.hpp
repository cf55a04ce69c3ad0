// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"
#include "sim/recording.hpp"

/// sweep_messages.hpp converts lidar sweeps to messages. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Returns sweep number `sweep` of a lidar as a message. The sweep starts at `start_ns` since 1970, as stated in
/// `header`. Throws BadInput for a CustomMsg of a lidar with more than 256 lines.
ros::Message sweep_message(const sim::LidarRecord& lidar, std::size_t sweep, const SweepLayout& layout,
                           std::int64_t start_ns, const ros::Header& header);

}  // namespace tumble::scenarios
