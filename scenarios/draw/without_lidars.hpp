// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/situation.hpp"

namespace tumble::scenarios {

/// The situation without its lidars, which cost most of a simulation's memory and a good part of its time. Motion and
/// IMU readings stay the same, bit for bit: each sensor draws from streams of its own.
sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation);

}  // namespace tumble::scenarios
