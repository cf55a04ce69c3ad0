// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Converts an estimate to a track of body poses, with the mounting that the estimator used; velocities are not
/// written. With a truth, the track is aligned as in the scores: to the true position and heading at the first pose
/// that the truth covers (truth_track.hpp).
///
/// The returns of the first lidar become clouds, placed by the interpolated estimated pose of the lidar and stamped at
/// the sweep's end. Returns outside the poses or in gaps longer than 0.2 s are omitted. `error_m` is the distance to
/// the ray's true hit, including range noise; it needs true hits. Clouds are created when the bag is written:
/// `sensors`, `points` (stores per lidar if on disk; null: in the records) and `truth` must live until then.
///
/// Throws BadInput: no pose, no pose within the truth, or a frame of a missing sensor.
BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth);

/// Reads estimates and adds them to `writing`, with its points and truth. Each is a folder, or a TUM file with poses of
/// the first IMU (without IMU: of the body), in the recording's clock or its source's clock. The track is named after
/// the method, "slam_tumble", with a number if that is taken. Throws BadInput with the path: errors of reading, an
/// estimate of other sensors, errors of in_bag.
void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing);

}  // namespace tumble::scenarios
