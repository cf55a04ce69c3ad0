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

/// The poses of an estimate as poses of the body, by the mounting that the estimator was given; velocities are not
/// written. With a truth, all is moved as the scores move it: to the truth's position and heading at the first pose
/// that the truth covers (truth_track.hpp). Each return of the first lidar is put where the estimate has the lidar at
/// that instant (poses interpolated, linearly and by slerp), stamped at the end of its sweep; returns before the first
/// pose, after the last one or across a hole of more than 0.2 s are left out. `error_m` is the distance from there to
/// where the ray truly ended; it has the noise of the range in it, and is there only where the truth knows hits. A
/// cloud is made when the bag comes to it: `sensors`, `points` (of each lidar, where they are set aside; null: in the
/// records) and `truth` must live until then. Throws BadInput: no pose, none that the truth covers, a frame of a sensor
/// that the recording does not have.
BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth);

/// Reads estimates (folders, or TUM files with poses of the first IMU, of the body where there is none, in the
/// recording's clock or in that of its source) and puts them into `writing`, whose points and truth they are laid
/// on, each under its method's name: "slam_tumble", with a number behind it where that is taken. Throws BadInput with
/// the path: what reading says, an estimate of other sensors, what in_bag says.
void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing);

}  // namespace tumble::scenarios
