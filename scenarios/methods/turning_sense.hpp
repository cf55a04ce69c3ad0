// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"

/// Somebody else's attitudes against the gyro: a file of poses does not say whose they are, nor which way its
/// quaternions go.
namespace tumble::scenarios {

/// What is wrong with how the attitudes or poses of `estimate` turn, "" where nothing is shown: quaternions with w
/// first, of the world in the sensor instead of the sensor in the world, of another frame than `estimate.frame`.
///
/// Compared are rotations between poses 0.05 to 0.5 s apart, in the axes of the frame, with the gyro's of the first IMU
/// (product of exponentials of its samples, none of them at its rail or across a gap), as the median of the difference
/// over the median rotation. Told is what brings a difference of more than a half below 0.15, over six pairs of
/// 0.02 to 2.5 rad at least. Not told: what fits no single one of these, a motion about one axis that stays as it is
/// under the error. O(samples + poses).
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
