// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

/// A robot whose sensors' body hangs on joints: its state follows from theirs.
namespace tumble::sim::engine {

/// Brings poses and velocities of all bodies up to date with the joints, after a step or a change by hand: the engine
/// leaves them as they were at the last stage of its integration.
void update_bodies(const mjModel& model, mjData& data);

/// State of a body after update_bodies.
BodyState state_on_joints(const mjModel& model, const mjData& data, int body);

/// State of the sensors' body before anything has moved; time 0.
BodyState state_at_rest(const World& world);

/// Turns the joints so that the sensors' body is at `T_WB`, or as near as they let it (least squares of metres and
/// radians), beginning from how they are: a recording holds the pose of that body alone. Where joints can reach a pose
/// in two ways (an elbow left or right), it is the one that is nearer to where they began. Poses of the bodies are up
/// to date after it.
void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data);

}  // namespace tumble::sim::engine
