// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"

/// Slam methods beside those of registry.hpp, and what several of them share.
namespace tumble::scenarios {

Method slam_seed();
Method slam_constant_velocity();
Method slam_constant_jerk();
Method slam_iterated_filter();
Method slam_pointwise_reject();
Method slam_health_switch();
Method slam_floor();

/// The gyro as it is, with the axes named that are at their rail. One RateState per sample.
Status railed_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);

}  // namespace tumble::scenarios
