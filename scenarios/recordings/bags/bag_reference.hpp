// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"

/// Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// Makes the poses of `reading.reference_topic` (Odometry or PoseStamped) the truth of the recording. Whose they are is
/// what the one who imports them says, else, by an Odometry's child_frame_id, the frame that they are of, where the bag
/// places it. Throws BadInput with topic and message.
void attach_reference(const OpenedBag& bag, const SensorPlaces& places, const BagReading& reading, Imported& out);

}  // namespace tumble::scenarios
