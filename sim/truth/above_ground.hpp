// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// A strut deeper than this below the ground for much more than 30 ms is wedged. In a hard impact, the soft contact
/// yields by several centimetres for about 30 ms.
inline constexpr double kDipDepth_m = 0.01;
inline constexpr double kDip_s = 0.05;

/// Checks that a sensor stays above the ground, because runs with a wedged robot are useless for judging estimators.
/// Only height fields are checked, not planes, rocks, trunks and walls.
void require_above_ground(const engine::World& world, const Truth& truth, const std::string& sensor,
                          const Eigen::Vector3d& p_BX_m);

}  // namespace tumble::sim
