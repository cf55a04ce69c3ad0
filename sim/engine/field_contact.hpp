// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <optional>

/// Computes the contacts of struts with the ground from geometry. The engine would run GJK on every prism of ground in
/// the box around a strut, four times per step, which takes half the time of a tumble.
namespace tumble::sim::engine {

/// Computes the contacts of a capsule with the prisms of a height field. The contacts agree with the engine's contacts
/// within the engine's tolerance (1e-6 m). There is at most one contact per prism, in the order of rows and columns.
/// The position is midway between the two surfaces, and the normal points from the ground to the axis. `contacts` must
/// have room for mjMAXCONPAIR contacts; the function returns the number of contacts. Returns no value if the engine's
/// own search is needed: the axis is in the ground (penetration beyond the radius), the field is rotated, or the strut
/// is as low as the bottom of the field. `field` and `capsule` are geoms with up-to-date poses. For an axis along a
/// face, the engine's contact may be anywhere along the face; this function places the contact at an end.
std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field, int capsule,
                                  mjPreContact* contacts);

/// Replaces the engine's function for a height field and a capsule in the engine's table, which the whole process
/// shares. The function may be called repeatedly, from any thread.
void find_field_contacts_by_geometry();

}  // namespace tumble::sim::engine
