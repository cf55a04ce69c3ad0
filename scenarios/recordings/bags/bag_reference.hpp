// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

namespace tumble::scenarios {

/// The poses of the topic `reading.reference_topic` replace the truth. By default, the frame of the reference poses is
/// the child_frame_id of the messages, if the bag contains its transform.
void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out);

}  // namespace tumble::scenarios
