// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "sim/motion/held.hpp"

namespace tumble::sim {

struct HandHeldPose {
  Eigen::Vector3d p_m;  ///< centre of mass, in world axes
  Eigen::Quaterniond q;
};

/// Function that returns the pose of the hand at a time. The velocity must be continuous, because the path is
/// differentiated twice numerically.
using HandHeldPath = std::function<HandHeldPose(double time_s)>;

/// Returns the force and torque of a hand that carries a robot along a path. The force is the sum of a feed-forward
/// term for the acceleration of the path, a spring and a damper.
Wrench carry_along(const HoldingHand& hand, const Eigen::Matrix3d& inertia_B_kg_m2, const BodyState& state,
                   const HandHeldPath& path);

Eigen::Matrix3d carried_inertia_B_kg_m2(const HoldingHand& hand);

/// Returns a smooth step from 0 at u = 0 to 1 at u = 1, with continuous acceleration: 10 u^3 - 15 u^4 + 6 u^5.
double eased(double u);

}  // namespace tumble::sim
