// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/motion/motion_type.hpp"
#include "sim/parameters.hpp"

namespace tumble::sim {

inline constexpr std::array kImpulseParameters = {
    Parameter{"direction_rad", 0.0, -3.2, 3.2, "rad",
              "direction of the push, as a rotation about z; 0: down the slope"},
    Parameter{"spin_forward_rad_s", 4.0, -100.0, 100.0, "rad/s",
              "change of the angular velocity about the axis of forward rolling, caused by the push (angular impulse "
              "over inertia)"},
    Parameter{"spin_side_rad_s", 0.0, -100.0, 100.0, "rad/s",
              "change of the angular velocity about the direction of the push, caused by the push (angular impulse "
              "over inertia)"},
    Parameter{"spin_up_rad_s", 0.0, -100.0, 100.0, "rad/s",
              "change of the angular velocity about the vertical, caused by the push (angular impulse over inertia)"},
};

/// Returns the linear and angular impulse in world axes [N s, N m s] that starts the motion of a body at rest.
Wrench whole_impulse(const Values& values, double mass_kg, const Eigen::Matrix3d& inertia_W_kg_m2);

}  // namespace tumble::sim
