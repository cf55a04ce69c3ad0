// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/draw/scenario.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

/// Returns true if the scenario has a lidar.
bool has_lidar(const Scenario& scenario);

/// Returns the situation without its lidars, which need most of a simulation's memory and much of its time. Motion and
/// IMU readings stay bit-identical without lidars, because each sensor has its own random streams.
sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation);

}  // namespace tumble::scenarios
