// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/estimate.hpp"

/// A pose file does not specify its frame, quaternion convention or clock. A comparison of the poses with the gyro
/// detects wrong assumptions about frame, quaternion convention or clock.
namespace tumble::scenarios {

/// Returns a message if the rotations of the poses contradict the gyro for one of the following reasons, otherwise an
/// empty text:
/// - The quaternions have w first.
/// - The quaternions are inverse rotations (world in sensor axes).
/// - The poses belong to another frame than `estimate.frame`.
///
/// The function returns a message only if both conditions are met:
/// - The rotations of the poses differ from the rotations of the gyro by more than 50 %.
/// - A correction of the frame or the quaternion convention reduces the difference below 15 %.
///
/// A rotation about a single axis does not reveal every wrong frame or quaternion convention.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the time stamps of the poses have a constant error of 0.15 to 5 s.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
