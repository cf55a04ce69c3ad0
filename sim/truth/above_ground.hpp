// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// A sensor may permanently be below the ground by up to kDipDepth_m, and deeper for less than the allowed time. A soft
/// contact yields by several centimetres for about 30 ms of a hard impact; a longer penetration means that the robot is
/// wedged.
inline constexpr double kDipDepth_m = 0.01;
inline constexpr double kDip_s = 0.05;

/// Checks that a sensor stays above the ground. Contacts are soft: a hard impact may push the robot so deep into a
/// height field that it stays wedged, with its lidar below the surface. Simulated runs with a wedged robot must not be
/// used to judge estimators. `truth` contains the poses of the body; `p_BX_m` is the position of the sensor on the
/// body. The depth is the distance below the plane of the ground triangle. Throws SimulationFailure with sensor, time,
/// depth and limit. The check covers only height fields, not planes, rocks, trunks and walls.
void require_above_ground(const engine::World& world, const Truth& truth, const std::string& sensor,
                          const Eigen::Vector3d& p_BX_m);

}  // namespace tumble::sim
