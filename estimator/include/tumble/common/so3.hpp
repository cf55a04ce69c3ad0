// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tumble/common/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble::so3 {

/// Returns the skew-symmetric matrix [v]x with [v]x w = v x w.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Returns the unit quaternion of a rotation by |phi| radians about the vector phi.
Eigen::Quaterniond exp(const Eigen::Vector3d& phi);

/// Returns the shortest rotation vector (length at most pi) of a unit quaternion. For a half turn, the first non-zero
/// component of the rotation vector is positive.
Eigen::Vector3d logarithm(const Eigen::Quaterniond& q);

/// Returns the left Jacobian J_l(phi) of SO(3), defined by Exp(phi + d) = Exp(J_l d) Exp(phi) to first order in d.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi);

/// Returns the inverse of the left Jacobian of SO(3), which is finite for |phi| < 2 pi.
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);

/// Returns the smallest rotation that turns the unit vector `from` into the unit vector `to`.
Eigen::Quaterniond shortest_arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace tumble::so3
