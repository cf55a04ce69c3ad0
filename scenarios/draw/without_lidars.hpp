// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/draw/scenario.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

/// Whether a scenario's draws have a lidar.
bool has_lidar(const Scenario& scenario);

/// The situation without its lidars, which cost most of a simulation's memory and a good part of its time. Motion and
/// IMU readings stay the same, bit for bit: each sensor draws from streams of its own.
sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation);

}  // namespace tumble::scenarios
