// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/odometry/rolling_odometry.hpp"

namespace tumble::scenarios {

/// IMUs without a data sheet get wider priors.
RollingOdometry::Params stated_params(const sim::Sensors& sensors, const SphereImus& units,
                                      RollingOdometry::Params params);

void append_pose(const RollingOdometry::Pose& pose, double radius_m, Estimate& estimate);

}  // namespace tumble::scenarios
