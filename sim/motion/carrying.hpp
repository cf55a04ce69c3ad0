// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "sim/motion/held.hpp"

namespace tumble::sim {

/// HandHeldPose is the target pose of a robot that a hand carries.
struct HandHeldPose {
  Eigen::Vector3d p_m;  ///< centre of mass, in W
  Eigen::Quaterniond q;
};

/// HandHeldPath is a smooth path over time, defined at any time, also before 0. The path is differentiated twice
/// numerically, so its velocity must be continuous.
using HandHeldPath = std::function<HandHeldPose(double time_s)>;

/// Returns the wrench (force and torque) of a hand that carries a robot along a path. The wrench causes the path's
/// acceleration; a spring and a damper correct deviations from the path. The hand has no body in the simulation.
/// `inertia_B_kg_m2` is about the centre of mass, in B axes.
Wrench carry_along(const HoldingHand& hand, const Eigen::Matrix3d& inertia_B_kg_m2, const BodyState& state,
                   const HandHeldPath& path);

/// Returns the moment of inertia of the robot that `hand` carries, about the robot's centre of mass in B axes [kg m^2].
Eigen::Matrix3d carried_inertia_B_kg_m2(const HoldingHand& hand);

/// Returns a smooth step from 0 at u = 0 to 1 at u = 1 with continuous acceleration: 10 u^3 - 15 u^4 + 6 u^5. The step
/// is constant outside.
double eased(double u);

}  // namespace tumble::sim
