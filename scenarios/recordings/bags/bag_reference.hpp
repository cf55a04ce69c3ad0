// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

namespace tumble::scenarios {

/// Uses the poses of the topic `reading.reference_topic` as the truth. The user chooses the frame of the poses; by
/// default, it is the child_frame_id of the messages, if the bag contains its transform. Throws BadInput, with topic
/// and message, if the poses are invalid.
void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out);

}  // namespace tumble::scenarios
