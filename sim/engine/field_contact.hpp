// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <optional>

/// field_contact.hpp computes the contacts between struts (capsules of the robot's cage) and the ground in closed form.
/// MuJoCo's iterative method (GJK) for every prism of ground near a strut would take half of the computing time of a
/// tumble.
namespace tumble::sim::engine {

/// Computes the contacts of a capsule with the prisms of a height field, and returns their number. The contacts agree
/// with those of MuJoCo within MuJoCo's tolerance (1e-6 m). Each prism of ground has at most one contact; the contacts
/// are ordered by rows and columns. A contact is midway between the two surfaces, and its normal points from the ground
/// to the axis. `contacts` must have room for mjMAXCONPAIR contacts. `field` and `capsule` are geoms whose poses must
/// be up to date. If the strut is parallel to a face, MuJoCo may place the contact anywhere along the face;
/// field_contacts() places it at one end. Returns nothing if the strut's axis is below the ground surface, the field is
/// rotated, or the strut is as low as the field's bottom. The caller must then use MuJoCo's own search.
std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field, int capsule,
                                  mjPreContact* contacts);

/// Replaces MuJoCo's collision function for a height field and a capsule, in the table that the whole process shares.
/// The function may be called repeatedly and from any thread.
void find_field_contacts_by_geometry();

}  // namespace tumble::sim::engine
