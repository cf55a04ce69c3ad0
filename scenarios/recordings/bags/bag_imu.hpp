// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

namespace tumble::scenarios {

struct ImuTopic {
  sim::ImuRecord imu;
  std::int64_t record_lag_ns = 0;  ///< smallest delay from header stamp to record stamp
};

/// Reads the messages of an IMU topic. If the topic has no messages, read_imu() throws BadInput if the caller chose the
/// topics, and otherwise returns a record without readings.
ImuTopic read_imu(const OpenedBag& bag, SensorMountings& places, const std::string& topic, const BagReading& reading,
                  std::vector<std::string>& notes);

std::string repeats_text(std::size_t repeated);

}  // namespace tumble::scenarios
