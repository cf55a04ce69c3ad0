// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"

/// slam_conclusion.hpp computes the final results of a slam run.
namespace tumble::scenarios {

/// Replaces the trajectory of a sweep by the smoothed trajectory; an empty `smoothed` changes nothing.
void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// Writes the final poses, the map and the status of a run to the estimate, which already contains sweeps and findings.
/// All slam methods call `conclude`. The run is localised if no finding contradicts its pose in the map
/// (report_localised). The status is `too_few` if no sweep was registered. `scale` is null if the scale of the lidar
/// was not checked. Returns true if the run is localised and completed.
bool conclude(const LidarInertialOdometry& odometry, const Localisation& localisation, const SweepScale* scale,
              Estimate& estimate);

/// Adds the difference between estimated and recorded calibration of the lidar to the health.
void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health);

/// Adds the number of passes over the recording to the health, and whether the calibration of the lidar converged.
void report_passes(const MappedRecording& mapped, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
