// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <optional>

/// Computes the contacts of struts with the ground from geometry. MuJoCo would run GJK on every prism of ground in the
/// box around a strut, four times per step, which takes half the computing time of a simulated tumble.
namespace tumble::sim::engine {

/// Computes the contacts of a capsule with the prisms of a height field. The contacts agree with MuJoCo's contacts
/// within MuJoCo's tolerance (1e-6 m). Each prism has at most one contact; the contacts are in the order of rows and
/// columns. The position of a contact is midway between the two surfaces, and its normal points from the ground to the
/// axis. `contacts` must have room for mjMAXCONPAIR contacts; the function returns the number of contacts. Returns no
/// value if MuJoCo's own search is needed. MuJoCo's search is needed if the strut's axis is in the ground (penetration
/// beyond the radius), if the field is rotated, or if the strut is as low as the bottom of the field. `field` and
/// `capsule` are geoms with up-to-date poses. For an axis along a face, MuJoCo's contact may be anywhere along the
/// face; field_contacts places the contact at an end.
std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field, int capsule,
                                  mjPreContact* contacts);

/// Replaces MuJoCo's collision function for a height field and a capsule in MuJoCo's table, which the whole process
/// shares. The replacement may be repeated, from any thread.
void find_field_contacts_by_geometry();

}  // namespace tumble::sim::engine
