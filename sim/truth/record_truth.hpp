// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/engine/model.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// Lets the robot settle at the motion's start, then simulates `duration_s` and records the body's truth at every step:
/// pose, velocity, rate, specific force, contacts and their labels (Truth's sensor parts stay empty). Throws
/// SimulationFailure: see Physics::step; also when the robot does not come to rest before the start or never moves.
Truth record_truth(engine::World& world, Motion& motion, double duration_s);

/// Mean specific force at a point fixed to the body over one step, in the axes of the middle attitude: R_mid^T ((v1 -
/// v0)/dt
/// - g). `p_BP_m` is the point. Summing R_mid f dt + g dt gives the velocity of the point back exactly.
Eigen::Vector3d specific_force_B(const BodyState& before, const BodyState& after, const Eigen::Vector3d& p_BP_m,
                                 double gravity_m_s2);

/// Mean rate over one step: the rotation between the two attitudes over the time. No error from the step's length as
/// long as the step turns by less than pi.
Eigen::Vector3d mean_rate_B(const BodyState& before, const BodyState& after);

/// Labels every physics sample by the contacts within 10 ms of it (contacts chatter: at low friction a third of the
/// steps has none). `air`: none. `grip`: mean slip speed, weighted by normal force, below 0.02 m/s. Else `slip` when
/// the rotation is too fast for the motion of the geometric centre, `slide` when it is too slow (weighted mean of the
/// difference of the two speeds along the ground). Touchdown is labelled 10 ms early and take-off as late; the border
/// between slide and grip lies within 4 ms of Coulomb's law. A body that is no sphere is judged at its centre of mass.
std::vector<ContactLabel> label_contacts(const Truth& truth);

}  // namespace tumble::sim
