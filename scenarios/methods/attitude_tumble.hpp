// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"

/// The header declares the parts of the method attitude/tumble that attitude/tumble_lag also uses.
namespace tumble::scenarios {

/// Returns the settings of the attitude filter, with the library's defaults.
const Settings<TumbleAttitude::Params>& attitude_tumble_settings();

/// Reports for how long the inclination is unknown: two standard deviations exceed 1 rad. The report is a failed health
/// check and the health value `attitude_unknown_s`. An IMU gap in a tumble can make the inclination unknown.
void report_unknown_attitude(Estimate& estimate);

}  // namespace tumble::scenarios
