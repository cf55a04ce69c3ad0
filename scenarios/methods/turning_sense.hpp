// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// A pose file does not specify its frame, quaternion convention or clock.
namespace tumble::scenarios {

/// Returns a message if the attitudes or poses have quaternions with w first, inverse rotations (world in sensor), or
/// another frame than `estimate.frame`; otherwise an empty text.
///
/// A wrong convention is reported if the rotations differ from the first IMU's gyro by more than half, and a correction
/// reduces the difference below 0.15 (recordings/trajectories/turning.hpp). Combined errors, and errors that leave
/// rotations about a single axis unchanged, are not detected. The cost is O(samples + poses).
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the time stamps of the attitudes or poses have a constant error of 0.15 to 5 s.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
