// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// The functions in turning_sense.hpp check the rotation convention and the clock of external attitudes against the
/// gyro. A pose file does not specify its frame, quaternion convention or clock.
namespace tumble::scenarios {

/// Returns a message if the attitudes or poses of `estimate` use a wrong convention; otherwise returns "". The function
/// detects quaternions with w first, inverse rotations (world in sensor), and a frame other than `estimate.frame`.
///
/// The function compares rotations between poses with the gyro of the first IMU (recordings/trajectories/turning.hpp).
/// A wrong convention is reported if the rotation difference exceeds half of the rotation and the correction reduces
/// the difference below 0.15. The function cannot detect combined errors, or errors that leave rotations about a single
/// axis unchanged. The cost is proportional to the number of samples and poses.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the time stamps of the attitudes or poses have a constant error of 0.15 to 5 s; otherwise
/// returns "". The check is the same as for references (recordings/trajectories/reference_check.hpp). The check takes
/// about half a second.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
