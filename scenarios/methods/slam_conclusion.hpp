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

/// Returns true if the run is complete and its final pose in the map is plausible.
bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate);

void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health);

void report_passes(const MappedRecording& mapped, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
