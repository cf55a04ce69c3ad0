// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates the delay between gyro and accelerometer of a device, up to four samples, by impacts or flight. Cost: O(N)
/// for each of about 60 delays. Repeated readings count once, at their true times.
///
/// The first method uses impacts. An impact changes the rotation, so the angular acceleration is large when the
/// specific force is large. The estimate is the delay with the best correlation of the roots of angular acceleration
/// and force, over equal intervals between unsaturated gyro readings. The correlation must be at least 0.6. At least 30
/// readings must be faster than 1 rad/s, with 10 readings above 30 m/s^2 and a tenth below 5 m/s^2. If a condition is
/// not met, the body may be hand-held, and impacts give no estimate. The accuracy of the first method is 0.15 of the
/// period of the slower sensor.
///
/// The second method uses flight, if impacts give no estimate. The estimate is the delay for which most accelerometer
/// readings equal the force of flight at a rigid body's lever arm. The force of flight is alpha x t + w x (w x t) +
/// bias, with lever arm t, rate w and angular acceleration alpha. For each delay, lever arm (prior `lever_arm_m`, 0.02
/// m) and bias are fitted robustly (Geman-McClure). The result is empty with fewer than 20 unclipped readings faster
/// than 2 rad/s, or if the improvement may be due to chance.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
