// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/odometry/rolling_odometry.hpp"

/// position_tumble.hpp contains functions that the position methods of tumble and their oracles share.
namespace tumble::scenarios {

/// Returns the parameters of RollingOdometry that the recording states. IMUs without a data sheet get wider priors.
RollingOdometry::Params stated_params(const sim::Sensors& sensors, const SphereImus& units,
                                      RollingOdometry::Params params);

/// Appends a pose with its contact state to the estimate.
void append_pose(const RollingOdometry::Pose& pose, double radius_m, Estimate& estimate);

}  // namespace tumble::scenarios
