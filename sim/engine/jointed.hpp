// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

/// jointed.hpp is for robots whose sensor body is attached by joints. The joint angles determine the state of the
/// sensor body.
namespace tumble::sim::engine {

/// Updates poses and velocities of all bodies from the joints, after a step or a manual change. Without a call of
/// update_bodies(), MuJoCo's bodies have the poses of the last integration stage of a step.
void update_bodies(const mjModel& model, mjData& data);

/// Returns the state of a body. The caller must call update_bodies first.
BodyState state_on_joints(const mjModel& model, const mjData& data, int body);

/// Returns the state of the sensor body before any motion, at time 0.
BodyState state_at_rest(const World& world);

/// Moves the joints from their current angles so that the sensor body is as close as possible to `T_WB` (least squares
/// of metres and radians). The function computes joint angles for a recording, which contains only the pose of the
/// sensor body. If two joint configurations reach the pose (an elbow left or right), the result is the one nearer to
/// the start. After the call, the poses of all bodies are up to date.
void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data);

}  // namespace tumble::sim::engine
