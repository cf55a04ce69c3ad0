// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim::engine {

/// Before update_bodies() is called, MuJoCo's bodies have the poses of the last integration stage of a step.
void update_bodies(const mjModel& model, mjData& data);

/// The caller must call update_bodies() before state_on_joints().
BodyState state_on_joints(const mjModel& model, const mjData& data, int body);

BodyState state_at_rest(const World& world);

/// Moves the joints from their current angles so that the sensor body is as close as possible to `T_WB` (least squares
/// of metres and radians).
void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data);

}  // namespace tumble::sim::engine
