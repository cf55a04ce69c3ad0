// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// A pose file does not specify its frame, quaternion convention or clock, so the gyro serves to detect errors in them.
namespace tumble::scenarios {

/// Returns a message if the quaternions of the poses have w first, are inverse rotations (world in sensor), or refer to
/// another frame than `estimate.frame`; otherwise an empty text.
///
/// A wrong convention is reported if the rotations differ from the first IMU's gyro by more than half, and a correction
/// reduces the difference below 0.15. Combined errors, and errors that leave rotations about a single axis unchanged,
/// are not detected.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the time stamps of the poses have a constant error of 0.15 to 5 s.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
