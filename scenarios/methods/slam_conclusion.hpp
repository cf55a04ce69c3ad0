// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::scenarios {

void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// Returns true if the run is complete and its final pose in the map is plausible.
bool conclude(const LidarInertialOdometry& odometry, Estimate& estimate);

}  // namespace tumble::scenarios
