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
/// Compares rotations from pose to pose with those of the first IMU's gyro (recordings/trajectories/turning.hpp).
/// Complains where the difference exceeds half of the rotation and another reading brings it below 0.15. An error that
/// no single other reading explains, and a motion about one axis that the error leaves as it is, show nothing.
/// O(samples + poses).
std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
