// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/engine/model.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// Simulates the true motion. Throws SimulationFailure in the same cases as Physics::step(), and if the robot does not
/// come to rest before the start or never moves.
Truth record_truth(engine::World& world, Motion& motion, double duration_s);

/// Returns the mean specific force at a body-fixed point P over one step, in the body axes halfway through the step's
/// rotation. The integral of specific force plus gravity over the step is exactly the velocity change of P.
Eigen::Vector3d specific_force_B(const BodyState& before, const BodyState& after, const Eigen::Vector3d& p_BP_m,
                                 double gravity_m_s2);

/// Returns the mean angular velocity over one step, without discretisation error if the body turns by less than half a
/// revolution.
Eigen::Vector3d mean_rate_B(const BodyState& before, const BodyState& after);

/// Labels every physics sample by the contacts within 10 ms before and after the sample. The time window is necessary
/// because simulated contacts are interrupted: at low friction, a third of the simulation steps have no contact.
/// - `air`: there is no contact.
/// - `grip`: mean slip speed, weighted by normal force, below 0.02 m/s.
/// - `slip`: the rotation is too fast for the motion of the geometric centre.
/// - `slide`: the rotation is too slow for the motion of the geometric centre.
///
/// Because of the time window, the labels show touchdown 10 ms too early and take-off 10 ms too late. For a body other
/// than a sphere, `slip` and `slide` refer to the motion of the centre of mass.
std::vector<ContactLabel> label_contacts(const Truth& truth);

}  // namespace tumble::sim
