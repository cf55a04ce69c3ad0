// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Converts an estimate to a track of body poses, with the sensor mounting that the estimator used. The track is
/// aligned with the truth in the same way as for the scores. Points outside the time span of the poses, or in gaps of
/// the poses longer than 0.2 s, are omitted. The field `error_m` is the distance between a point and the true hit of
/// its ray, including range noise. The clouds are computed when the bag is written, so `sensors`, `points` and `truth`
/// must exist until the bag is complete.
BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth);

/// Adds estimates from files to a bag. The poses of a TUM file are poses of the first IMU, or of the body if the
/// recording has no IMU.
void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing);

}  // namespace tumble::scenarios
