// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates the delay between gyro and accelerometer of a device, up to four samples, from impacts or from flight.
/// Cost: O(N) for each of about 60 delays. Repeated readings count once, at their true times.
///
/// An impact changes the rotation, so the angular acceleration is large when the specific force is large. The best
/// delay maximises the correlation between the square roots of angular acceleration and force, over equal intervals
/// between unsaturated gyro readings. The correlation of angular acceleration and force must be at least 0.6. At least
/// 30 readings must be faster than 1 rad/s, with 10 readings above 30 m/s^2 and a tenth of the readings below 5 m/s^2.
/// Otherwise the body may be hand-held, and the impacts give no estimate. The standard deviation of an estimate from
/// impacts is 0.15 of the slower sensor's period.
///
/// If the impacts give no estimate, the function uses flight. With the best delay, most accelerometer readings equal
/// the force of flight at the lever arm of a rigid body. The force of flight is alpha x t + w x (w x t) + bias, with
/// lever arm t, rate w and angular acceleration alpha. For each delay, the function fits lever arm (prior
/// `lever_arm_m`, 0.02 m) and bias robustly (Geman-McClure). The function returns nothing if fewer than 20 unclipped
/// readings exceed 2 rad/s, or if the improvement may be due to chance.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
