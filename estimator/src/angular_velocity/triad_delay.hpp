// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/stroke_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// A first guess of a device's delay, among delays of up to four samples, in two ways; readings that repeat count once,
/// at the instants of which they tell.
///
/// Where the body is struck: whatever strikes it turns it, so that the angular acceleration is large where the specific
/// force is. The delay at which the roots of both, taken over the same intervals of time between free readings of the
/// gyro, correlate best; believed from 0.6 on (30 readings faster than 1 rad/s, 10 of them beyond 30 m/s^2 and a tenth
/// below 5: what is struck and never flies is in a hand), to 0.15 of the slower triad's period. Else where it flies:
/// the delay at which the most of the accelerometer's readings are what a rigid body has at a lever arm, alpha x t + w
/// x (w x t) + bias, of the gyro's readings beside them. Lever arm (about `lever_arm_m`, 0.02 m) and bias are fitted
/// for each delay, readings that do not fit are left out (Geman-McClure); nothing where there are fewer than 20 that
/// turn faster than 2 rad/s with no axis clipped, or a gain that chance could have made. O(N) for each of some 60
/// delays.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
