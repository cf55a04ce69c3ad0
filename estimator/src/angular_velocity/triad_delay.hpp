// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates the delay between gyro and accelerometer, up to four samples, from impacts or from flight. Cost: O(N) for
/// each of about 60 delays.
///
/// At an impact, a large specific force coincides with a large angular acceleration. The best delay maximises the
/// correlation between the square roots of angular acceleration and force.
/// The delay from impacts requires a correlation of at least 0.6, and has a standard deviation of 0.15 sensor periods.
///
/// With the best delay from flight, most accelerometer readings equal alpha x t + w x (w x t) + bias. Here, t is the
/// lever arm, w the rate and alpha the angular acceleration. For each delay, a robust fit (Geman-McClure) estimates
/// lever arm (prior `lever_arm_m`, 0.02 m) and bias. Returns nothing if fewer than 20 unclipped readings exceed 2
/// rad/s, or if the improvement may be due to chance.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
