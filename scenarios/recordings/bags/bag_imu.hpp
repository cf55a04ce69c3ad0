// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

/// Reads the IMU topics of a bag. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Reads a topic of type sensor_msgs/Imu. Leaves out single faulty messages, with a note. Returns no readings for a
/// topic without messages, unless the caller chose the topics. Throws BadInput for implausible units, or if too many
/// messages are faulty.
sim::ImuRecord read_imu(const OpenedBag& bag, SensorPlaces& places, const std::string& topic, const BagReading& reading,
                        std::vector<std::string>& notes);

/// Notes the number of duplicate messages, or returns "".
std::string repeats_text(std::size_t repeated);

}  // namespace tumble::scenarios
