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

/// Converts an estimate to a track of body poses, with the sensor mounting that the estimator used. Velocities of the
/// track are unknown. If the truth is known, the track is aligned like the scores: to the true position and heading at
/// the first pose within the time of the truth (truth_track.hpp).
///
/// The returns of the first lidar become point clouds. The interpolated estimated pose of the lidar transforms each
/// return, and the cloud's stamp is the end of the sweep. Returns outside the time of the poses, or in gaps longer than
/// 0.2 s, are omitted. The field `error_m` is the distance between a point and its ray's true hit, including range
/// noise; this field needs true hits. The clouds are created when the bag is written, so `sensors`, `points` and
/// `truth` must live until then. `points` stores the points of each lidar on disk; if null, the points are in the
/// records.
///
/// Throws BadInput if the estimate has no pose, no pose within the time of the truth, or the frame of a missing sensor.
BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth);

/// Reads estimates and adds them to `writing`, with the points and the truth of `writing`. Each path is either a folder
/// with an estimate or a TUM file. The poses of a TUM file belong to the first IMU, or to the body if there is no IMU.
/// The stamps of a TUM file refer to the recording's clock or to the clock of the recording's source. The track is
/// named after the method, for example "slam_tumble", with a number appended if the name is taken. Throws BadInput with
/// the path for read errors, for an estimate of other sensors, and for errors of in_bag.
void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing);

}  // namespace tumble::scenarios
