// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"

/// slam_conclusion.hpp computes the final results of a slam run.
namespace tumble::scenarios {

/// Replaces the trajectory of a sweep by the smoothed trajectory; an empty `smoothed` changes nothing.
void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// Writes the final poses, map and status of a run to the estimate, which already contains the sweeps and the findings.
/// All slam methods call the function `conclude`. The run is localised unless a finding contradicts its pose in the map
/// (report_localised). The status is `too_few` if no sweep was registered. Returns true if the run is localised and
/// completed.
bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate);

/// Adds the difference between estimated and recorded calibration of the lidar to the health.
void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health);

/// Adds the number of passes over the recording to the health, and whether the calibration of the lidar converged.
void report_passes(const MappedRecording& mapped, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
