// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

/// attach_reference reads the reference poses of a bag.
namespace tumble::scenarios {

/// Reads the poses of the topic `reading.reference_topic` (Odometry, PoseStamped or TransformStamped) as the truth of
/// the recording. The frame of the poses is the user's choice, or else the child_frame_id of the messages, if the bag
/// contains its transform. Throws BadInput, with topic and message, if the poses are invalid.
void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out);

}  // namespace tumble::scenarios
