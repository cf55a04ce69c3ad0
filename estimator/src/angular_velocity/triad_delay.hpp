// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/stroke_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Guesses a device's delay, up to four samples, by two methods. Repeated readings count once, at their true times.
///
/// Method 1 uses impacts. An impact changes the rotation, so the angular acceleration is large when the specific force
/// is large. The estimate is the delay with the best correlation of the roots of angular acceleration and force, over
/// equal intervals between unsaturated gyro readings. The correlation must be at least 0.6, with 30 readings faster
/// than 1 rad/s, 10 of them above 30 m/s^2 and a tenth below 5 m/s^2. If a condition is not met, the body may be
/// hand-held. The accuracy is 0.15 of the slower triad's period.
///
/// Method 2 uses flight, if impacts give no estimate. The estimate is the delay for which most accelerometer readings
/// equal the force at a rigid body's lever arm. The force at a lever arm t is alpha x t + w x (w x t) + bias, with rate
/// w and angular acceleration alpha from the neighbouring gyro readings. Lever arm (prior `lever_arm_m`, 0.02 m) and
/// bias are fitted for each delay, robustly (Geman-McClure). The result is empty with fewer than 20 unclipped readings
/// faster than 2 rad/s, or for a gain that may be due to chance. O(N) for each of some 60 delays.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
