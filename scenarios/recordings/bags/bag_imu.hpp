// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

/// bag_imu.hpp reads the IMU topics of a bag.
namespace tumble::scenarios {

/// Reads the IMU samples of a topic of type sensor_msgs/Imu. Single faulty messages are skipped with a note. A topic
/// without messages gives no readings, except for an error if the caller chose the topics. Throws BadInput for
/// implausible units, or if too many messages are faulty.
sim::ImuRecord read_imu(const OpenedBag& bag, SensorMountings& places, const std::string& topic,
                        const BagReading& reading, std::vector<std::string>& notes);

/// Describes the number of duplicate messages; empty without duplicates.
std::string repeats_text(std::size_t repeated);

}  // namespace tumble::scenarios
