// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// A strut of the robot that is deeper than kDipDepth_m below the ground for longer than kDip_s is wedged. In a hard
/// impact, the soft contact yields by several centimetres, but only for about 30 ms.
inline constexpr double kDipDepth_m = 0.01;
inline constexpr double kDip_s = 0.05;

/// Checks that a sensor stays above the ground, because an estimator cannot be judged by a run with a wedged robot.
/// Only height fields are checked, and not planes, rocks, trunks and walls.
void require_above_ground(const engine::World& world, const Truth& truth, const std::string& sensor,
                          const Eigen::Vector3d& p_BX_m);

}  // namespace tumble::sim
