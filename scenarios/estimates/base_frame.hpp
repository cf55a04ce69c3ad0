// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "scenarios/estimates/estimate.hpp"
#include "scenarios/estimates/json_members.hpp"

/// Functions for estimates whose trajectory.tum contains poses of the base frame (Estimate::T_base_imu).
namespace tumble::scenarios {

inline constexpr const char *kBase = "base", *kBasePose = "T_base_imu";

/// Returns the poses for the file trajectory.tum. Poses of the base frame have no velocity of the base.
std::vector<PoseState> written_poses(const Estimate& estimate);

/// Returns the numbers of a pose: x y z [m] and the quaternion qx qy qz qw.
std::array<double, 7> numbers_of(const Eigen::Isometry3d& pose);
/// Reads a pose that numbers_of() wrote. Throws BadInput if the member is not a pose.
Eigen::Isometry3d pose_of(const JsonMembers& reader, const char* key);

}  // namespace tumble::scenarios
