// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/draw/scenario.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

/// Returns true if the scenario has a lidar.
bool has_lidar(const Scenario& scenario);

/// Returns the situation without its lidars, whose simulation needs most of the memory and much of the time. Motion and
/// IMU readings stay bit-identical, because each sensor has its own random stream.
sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation);

}  // namespace tumble::scenarios
