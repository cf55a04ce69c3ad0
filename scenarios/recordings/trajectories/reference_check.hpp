// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"
#include "sim/recording.hpp"

/// Whether a reference may become the truth of a recording. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Compares the rotations of a reference with those of the primary IMU's gyro (turning.hpp).
///
/// @param poses  Poses of the frame A in the recording's clock.
/// @param T_BA   Pose of that frame in the body, as the user or the messages state it.
/// @param where  Begins the messages: the file, or the bag and the topic.
/// @return       A remark: the reference agrees; or it disagrees, with the cause where the gyro shows one; or it was
///               not checked, and why.
/// Throws BadInput where the gyro shows that the quaternions have w first, that the poses are inverted, or that the
/// stamps are off by 0.15 s or more. What can be the IMU's fault or the mounting's is a caution instead.
std::string check_reference(const std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_BA,
                            const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
