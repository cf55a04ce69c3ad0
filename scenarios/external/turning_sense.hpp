// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/estimate.hpp"

/// A pose file does not specify its frame, quaternion convention or clock, so the gyro serves to detect errors in them.
namespace tumble::scenarios {

/// Returns a message if the quaternions of the poses have w first, are inverse rotations (world in sensor), or refer to
/// another frame than `estimate.frame`; otherwise an empty text.
///
/// The function returns a message only if both conditions are met: the rotations of the poses differ from the rotations
/// of the gyro by more than 50 %, and a correction reduces this difference below 15 %. A rotation about a single axis
/// does not reveal all errors.
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

/// Returns a message if the time stamps of the poses have a constant error of 0.15 to 5 s.
std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
