// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

/// jointed.hpp is for robots whose sensor body is attached by joints. The state of this body follows from the joint
/// angles.
namespace tumble::sim::engine {

/// Updates poses and velocities of all bodies from the joints, after a step or a manual change. After a step, MuJoCo's
/// bodies still have the poses of the last integration stage.
void update_bodies(const mjModel& model, mjData& data);

/// Returns the state of a body; the caller must call update_bodies first.
BodyState state_on_joints(const mjModel& model, const mjData& data, int body);

/// Returns the state of the sensor body before any motion, at time 0.
BodyState state_at_rest(const World& world);

/// Moves the joints so that the sensor body reaches `T_WB` as closely as possible (least squares of metres and
/// radians), from the current joint angles. A recording contains only the pose of the sensor body, from which this
/// function computes the joint angles. If two joint configurations reach the pose (an elbow left or right), the
/// function finds the one nearer to the start. After the call, the poses of all bodies are up to date.
void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data);

}  // namespace tumble::sim::engine
