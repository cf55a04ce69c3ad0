// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/engine/model.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// Throws SimulationFailure like Physics::step, and if the robot does not come to rest before the start or never moves.
Truth record_truth(engine::World& world, Motion& motion, double duration_s);

/// Returns the mean specific force at a body-fixed point P over one step, in the body axes halfway through the step's
/// rotation. The integral of specific force plus gravity over the step is exactly the velocity change of the body-fixed
/// point.
Eigen::Vector3d specific_force_B(const BodyState& before, const BodyState& after, const Eigen::Vector3d& p_BP_m,
                                 double gravity_m_s2);

/// The mean rate has no discretisation error if the body turns by less than pi in the step.
Eigen::Vector3d mean_rate_B(const BodyState& before, const BodyState& after);

/// Labels every physics sample by the contacts within 10 ms before and after the sample, because contacts are
/// interrupted. At low friction, a third of the steps has no contact.
/// - `air`: no contact.
/// - `grip`: mean slip speed, weighted by normal force, below 0.02 m/s.
/// - `slip`: the rotation is too fast for the motion of the geometric centre.
/// - `slide`: the rotation is too slow for the motion of the geometric centre.
///
/// The contact labels show touchdown 10 ms too early and take-off 10 ms too late. For a body other than a sphere,
/// `slip` and `slide` refer to the motion of the centre of mass.
std::vector<ContactLabel> label_contacts(const Truth& truth);

}  // namespace tumble::sim
