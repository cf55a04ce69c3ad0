// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Compares the rotations of a reference with the rotations that the gyro of the primary IMU measures (turning.hpp).
///
/// @param poses Poses of frame A in the recording's clock.
/// @param T_BA Pose of frame A in the body, from the user or the messages.
/// @return A note that the rotations agree, that they differ for a reason in the IMU or the mounting, or that the check
/// was impossible. Throws BadInput if the quaternions have w first, the poses are inverted, or the time stamps are
/// wrong by 0.15 s or more.
std::string check_reference(const std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_BA,
                            const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
