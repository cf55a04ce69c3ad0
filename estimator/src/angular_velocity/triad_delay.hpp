// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates the delay between gyro and accelerometer of a device, up to four samples, from impacts or from flight.
/// Cost: O(N) for each of about 60 delays. Repeated readings count once, at their true times.
///
/// Impacts: an impact changes the rotation, so a large specific force coincides with a large angular acceleration. The
/// best delay maximises the correlation between the square roots of angular acceleration and force, over equal
/// intervals between unsaturated gyro readings. An estimate from impacts requires:
/// - a correlation of at least 0.6,
/// - at least 30 intervals with rates above 1 rad/s,
/// - at least 10 intervals with a force above 30 m/s^2 (impact),
/// - a tenth of the intervals with a force below 5 m/s^2 (flight); otherwise the body may be hand-held.
/// The delay from impacts has a standard deviation of 0.15 of the slower sensor's period.
///
/// Flight: used if the impacts give no estimate. With the best delay, most accelerometer readings equal the force of
/// flight on a rigid body. The force of flight is alpha x t + w x (w x t) + bias, with lever arm t, rate w and angular
/// acceleration alpha. For each delay, the function fits lever arm (prior `lever_arm_m`, 0.02 m) and bias robustly
/// (Geman-McClure). Returns nothing if fewer than 20 unclipped readings exceed 2 rad/s, or if the improvement may be
/// due to chance.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
