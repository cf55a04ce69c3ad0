// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

/// Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Uses the poses of `reading.reference_topic` (Odometry, PoseStamped or TransformStamped) as the truth of the
/// recording. The user chooses the frame of the reference poses. Without a choice, the frame is the child_frame_id of
/// the messages if the bag contains its transform. Throws BadInput with topic and message.
void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out);

}  // namespace tumble::scenarios
