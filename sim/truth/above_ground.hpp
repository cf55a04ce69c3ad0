// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// A sensor may dip this far below the ground for as long as it likes, and farther for less than that time. A soft
/// contact gives by several centimetres for some 30 ms of a hard impact; what stays in the ground longer is wedged.
inline constexpr double kDipDepth_m = 0.01;
inline constexpr double kDip_s = 0.05;

/// Holds that a sensor stayed above the ground, as every real one does: contacts are soft, and a hard impact may drive
/// the robot so deep into a height field that they hold it there, its lidar looking at the surface from beneath. No
/// estimator is to be judged by that. `truth` has the poses of the body, `p_BX_m` is where the sensor sits on it. The
/// depth is the distance from the plane of the triangle of ground above. Throws SimulationFailure with sensor, time,
/// depth and bound. Height fields alone are asked: not planes, and no rocks, trunks or walls.
void require_above_ground(const engine::World& world, const Truth& truth, const std::string& sensor,
                          const Eigen::Vector3d& p_BX_m);

}  // namespace tumble::sim
