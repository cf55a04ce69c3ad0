// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// Checks the rotation convention and the clock of external attitudes against the gyro. The check is needed because a
/// pose file does not state its frame, quaternion convention or clock.
namespace tumble::scenarios {

/// Returns a message if the attitudes or poses of `estimate` use a wrong convention or clock, or "" if neither is
/// detected. Detects quaternions with w first, inverted rotations (world in sensor), a frame other than
/// `estimate.frame`, and stamps that are wrong by a constant time from 0.15 to 5 s.
///
/// Compares rotations between poses with the gyro of the first IMU (recordings/trajectories/turning.hpp). Reports a
/// correction if the rotation difference exceeds half of the rotation and the correction reduces the difference below
/// 0.15. Combinations of errors, and single-axis rotations that an error leaves unchanged, are not detected. Cost: see
/// check_turning; half a second.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
