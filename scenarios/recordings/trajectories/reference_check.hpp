// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"
#include "sim/recording.hpp"

/// reference_check.hpp checks whether reference poses may become the truth of a recording. Used only within
/// scenarios/recordings.
namespace tumble::scenarios {

/// Compares the rotations of a reference with the rotations that the primary IMU's gyro measures (turning.hpp).
///
/// @param poses  Poses of the frame A in the recording's clock.
/// @param T_BA   Pose of the frame A in the body, as the user or the messages state it.
/// @param where  Start of the messages: the file, or the bag and the topic.
/// @return       A note: the reference agrees; the reference disagrees, with the cause if the gyro shows one; or the
///               reference was not checked, with the reason.
/// Throws BadInput if the gyro shows that the quaternions have w first, that the poses are inverted, or that the stamps
/// are wrong by 0.15 s or more. A difference that the IMU or the mounting can cause only gives a warning.
std::string check_reference(const std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_BA,
                            const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
