// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "sim/motion/held.hpp"

namespace tumble::sim {

/// Where a hand means a robot to be.
struct CarriedPose {
  Eigen::Vector3d p_m;  ///< of the centre of mass, W
  Eigen::Quaterniond q;
};

/// A smooth way in time, at any time, also before 0. It is differenced twice: no jumps of velocity.
using CarriedPath = std::function<CarriedPose(double time_s)>;

/// The wrench of a hand that carries a robot along a way: a spring and a damper hold it there, the forces that the way
/// takes added beforehand. The hand is no body. `inertia_B_kg_m2` is about the centre of mass, B axes.
Wrench carry_along(const HoldingHand& hand, const Eigen::Matrix3d& inertia_B_kg_m2, const BodyState& state,
                   const CarriedPath& path);

/// Moment of inertia of the robot that `hand` holds, about its centre of mass, B axes [kg m^2].
Eigen::Matrix3d carried_inertia_B_kg_m2(const HoldingHand& hand);

/// 0 before 0, 1 after 1, rising without a jump of acceleration in between: 10 u^3 - 15 u^4 + 6 u^5.
double eased(double u);

}  // namespace tumble::sim
