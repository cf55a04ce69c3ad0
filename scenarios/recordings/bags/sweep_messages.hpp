// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// The sweep starts at `start_ns` since 1970, which is also the stamp in `header`. Throws BadInput for a CustomMsg of a
/// lidar with more than 256 lines.
ros::Message sweep_message(const sim::LidarRecord& lidar, std::size_t sweep, const SweepLayout& layout,
                           std::int64_t start_ns, const ros::Header& header);

}  // namespace tumble::scenarios
