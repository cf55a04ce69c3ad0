// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"

namespace tumble::scenarios {

void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// The run is localised unless a finding contradicts its pose in the map (report_localised). The status is `too_few` if
/// no sweep was registered. Returns true if the run is localised and completed.
bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate);

void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health);

void report_passes(const MappedRecording& mapped, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
