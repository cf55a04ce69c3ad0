// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

/// Which struts are so far above a height field that the engine need not look. It runs GJK on every prism of ground
/// under the box around a strut, four times a step, most of them for struts that touch nothing.
namespace tumble::sim::engine {

/// Whether a capsule surely touches no prism of a height field, both where `data` has them: each bit of its axis keeps
/// its radius and 0.1 mm more above the planes of the two triangles of every cell that it passes over. Says no where it
/// is in doubt, and for a field that is turned: no contact is ever lost. Of the struts of `hill` 1 it calls all clear
/// that touch nothing but 1 %. `field` and `capsule` are geoms; their poses are up to date.
bool clear_of_field(const mjModel& model, const mjData& data, int field, int capsule);

/// Puts that question before the engine's own function for a height field and a capsule, in the engine's table, which
/// the whole process shares. Contacts stay what they were, bit for bit. May be called again, from any thread.
void ask_for_clearance_first();

}  // namespace tumble::sim::engine
