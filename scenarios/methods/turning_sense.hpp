// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// Checks the rotation convention of external attitudes against the gyro. A pose file does not state its frame or
/// quaternion convention.
namespace tumble::scenarios {

/// Returns a message if the attitudes or poses of `estimate` use a wrong convention, "" if none is detected. Detects:
/// quaternions with w first, inverted rotations (world in sensor), and a frame other than `estimate.frame`.
///
/// Compares rotations between poses with the gyro of the first IMU (recordings/trajectories/turning.hpp). Reports a
/// correction if the difference exceeds half of the rotation and the correction reduces it below 0.15. Not detected:
/// combinations of errors, and single-axis rotations that an error leaves unchanged. O(samples + poses).
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
