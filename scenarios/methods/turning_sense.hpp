// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// turning_sense.hpp checks the rotation convention and the clock of external attitudes against the gyro. The check is
/// needed because a pose file does not state its frame, quaternion convention or clock.
namespace tumble::scenarios {

/// Returns a message if the attitudes or poses of `estimate` use a wrong convention, or "" if no wrong convention is
/// detected. The function detects quaternions with w first, inverted rotations (world in sensor), and a frame other
/// than `estimate.frame`.
///
/// The function compares rotations between poses with the gyro of the first IMU (recordings/trajectories/turning.hpp).
/// A correction is reported if the rotation difference exceeds half of the rotation and the correction reduces the
/// difference below 0.15. Combinations of errors, and single-axis rotations that an error leaves unchanged, are not
/// detected. The cost is proportional to the number of samples and poses.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the stamps of the attitudes or poses have a constant error of 0.15 to 5 s, or "" if no such
/// error is detected. The check equals the check of references (recordings/trajectories/reference_check.hpp). Cost:
/// about half a second.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
