// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim::engine {

/// Computes the poses of MuJoCo's bodies from the joint angles. After a simulation step, and before a call of
/// update_bodies(), the bodies have the poses of the last integration stage.
void update_bodies(const mjModel& model, mjData& data);

/// Returns the motion of a body that is attached by joints. The caller must call update_bodies() first.
BodyState state_on_joints(const mjModel& model, const mjData& data, int body);

BodyState state_at_rest(const World& world);

/// Moves the joints, starting at the current joint angles, such that the pose of the sensor body is as close as
/// possible to `T_WB` (least squares of metres and radians).
void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data);

}  // namespace tumble::sim::engine
