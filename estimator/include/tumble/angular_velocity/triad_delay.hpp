// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// How much later than the gyro the accelerometer of a device says the same instant, as a first guess [s]: among delays
/// of up to four samples the one at which the most of the accelerometer's readings are what a rigid body in free flight
/// has at a lever arm, alpha x t + w x (w x t) + bias, of the gyro's readings beside them. Lever arm (about
/// `lever_arm_m`, 0.02 m) and bias are fitted for each delay, readings that do not fit (contact, rest) are left out
/// (Geman-McClure). 0 where the readings say too little: fewer than 20 samples that turn faster than 2 rad/s with no
/// axis clipped, or a gain that chance could have made. O(N) for each of some 60 delays.
double guess_triad_delay_s(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                           const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
