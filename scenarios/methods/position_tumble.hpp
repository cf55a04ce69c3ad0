// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/odometry/rolling_odometry.hpp"

/// Position methods of tumble and methods that use the truth share the functions in position_tumble.hpp.
namespace tumble::scenarios {

/// Returns the parameters of RollingOdometry that the recording determines. IMUs without a data sheet get wider priors.
RollingOdometry::Params stated_params(const sim::Sensors& sensors, const SphereImus& units,
                                      RollingOdometry::Params params);

/// Appends a pose with its contact state to the estimate.
void append_pose(const RollingOdometry::Pose& pose, double radius_m, Estimate& estimate);

}  // namespace tumble::scenarios
