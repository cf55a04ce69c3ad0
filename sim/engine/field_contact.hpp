// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <optional>

/// Contacts of struts with the ground by geometry. The engine runs GJK on every prism of ground under the box around a
/// strut, four times a step: half the time of a tumble.
namespace tumble::sim::engine {

/// Contacts of a capsule with the prisms of a height field, as the engine makes them: at most one a prism, in the order
/// of rows and columns, its position midway between the two surfaces, its normal from ground to axis; within the
/// engine's tolerance of its own (1e-6 m). `contacts` has room for mjMAXCONPAIR of them; returns how many there are.
/// None is said where a search is needed, and the engine's own is the one to make it: an axis that is in the ground,
/// which goes deeper than the radius there, a field that is turned, a strut as low as its foot. `field` and `capsule`
/// are geoms; their poses are up to date. What the engine finds of an axis that lies along a face, anywhere along it,
/// is here at an end.
std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field, int capsule,
                                  mjPreContact* contacts);

/// Puts that in the place of the engine's function for a height field and a capsule, in the engine's table, which the
/// whole process shares. May be called again, from any thread.
void find_field_contacts_by_geometry();

}  // namespace tumble::sim::engine
