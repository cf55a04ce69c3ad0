// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates the delay between gyro and accelerometer, up to four samples, from impacts or from free flight. Cost: O(N)
/// for each of about 100 tested delays.
///
/// The delay from impacts maximises the correlation between two signals: the square root of the angular acceleration's
/// magnitude, and the square root of the specific force's magnitude. A delay from impacts requires a correlation of at
/// least 0.6. The standard deviation of the delay from impacts is 0.15 sensor periods.
///
/// In free flight, the returned delay minimises the residual of the rigid-body model of the specific force: alpha x t +
/// w x (w x t) + bias, for angular acceleration alpha, rate w and lever arm t. For each tested delay, a robust fit
/// (Geman-McClure) estimates bias and lever arm. The lever arm has the prior mean `lever_arm_m` and the prior standard
/// deviation 0.02 m. The returned delay is 0 if fewer than 20 unclipped gyro readings exceed 2 rad/s, or if no
/// other delay fits clearly better.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
