// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <optional>

/// Contacts of struts with the ground by geometry. The engine runs GJK on every prism of ground in the box around a
/// strut, four times per step; that takes half the time of a tumble.
namespace tumble::sim::engine {

/// Computes the contacts of a capsule with the prisms of a height field. The contacts agree with the engine's within
/// its tolerance (1e-6 m): at most one per prism, in the order of rows and columns, the position midway between the two
/// surfaces, and the normal from ground to axis. `contacts` has room for mjMAXCONPAIR contacts; the result is their
/// number.
/// Returns no value if the engine's own search is needed: the axis is in the ground (penetration beyond the radius),
/// the field is rotated, or the strut is as low as the field's foot. `field` and `capsule` are geoms with up-to-date
/// poses. For an axis along a face, the engine's contact may be anywhere along the face; here it is at an end.
std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field, int capsule,
                                  mjPreContact* contacts);

/// Replaces the engine's function for a height field and a capsule in the engine's table, which the whole process
/// shares. May be called repeatedly, from any thread.
void find_field_contacts_by_geometry();

}  // namespace tumble::sim::engine
