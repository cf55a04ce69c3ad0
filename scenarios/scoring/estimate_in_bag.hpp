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

/// Converts an estimate to a track of body poses, with the sensor mounting that the estimator used. The track contains
/// no velocities. If the truth is known, the track is aligned as for the scores: to the true position and heading at
/// the first pose within the time of the truth.
///
/// The points of the first lidar become point clouds in the bag. The interpolated lidar pose of the estimate transforms
/// each point, and the stamp of a cloud is the end of its sweep. Points outside the time of the poses, or in gaps of
/// the poses longer than 0.2 s, are omitted. The field `error_m` is the distance between a point and the true hit of
/// its ray, including range noise; this field needs true hits. The clouds are computed when the bag is written, so
/// `sensors`, `points` and `truth` must live until then. The vector `points` gives access to the points of each lidar
/// on disk; if null, the points are in `sensors`.
///
/// Throws BadInput if the estimate has no pose, no pose within the time of the truth, or the frame of a missing sensor.
BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth);

/// Reads estimates and adds each as a track to `writing`, with the points and the truth of `writing`. Each path is
/// either a folder with an estimate or a TUM file. The poses of a TUM file belong to the first IMU, or to the body if
/// there is no IMU. The stamps of a TUM file refer to the recording's clock or to the clock of the recording's source.
/// The track of an estimate is named after the method, for example "slam_tumble", with a number appended if the name is
/// taken. Throws BadInput with the path for a read error, for an estimate from other sensor data, and for the errors of
/// in_bag.
void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing);

}  // namespace tumble::scenarios
