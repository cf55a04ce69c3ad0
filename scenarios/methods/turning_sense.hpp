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
/// Compares rotations between poses 0.05 to 0.5 s apart with the integrated gyro of the first IMU, in the frame's axes.
/// Pairs with clipped samples or gaps are skipped. The measure is the median difference divided by the median rotation.
/// A correction is reported if it reduces this measure from above 0.5 to below 0.15, over at least six pairs of 0.02 to
/// 2.5 rad. Not detected: combinations of errors, and single-axis rotations that an error leaves unchanged. O(samples +
/// poses).
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
