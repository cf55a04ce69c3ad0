// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"

namespace tumble::scenarios {

const Settings<TumbleAttitude::Params>& attitude_tumble_settings();

/// The inclination counts as unknown while its double standard deviation exceeds 1 rad, for example after an IMU gap in
/// a tumble.
void report_unknown_attitude(Estimate& estimate);

}  // namespace tumble::scenarios
