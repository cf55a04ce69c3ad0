// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/tumble_attitude.hpp"

/// attitude_tumble.hpp declares the method attitude/tumble and its helper functions. Other methods call attitude/tumble
/// with modified readings.
namespace tumble::scenarios {

/// Returns the settings of the attitude filter, with the library's defaults.
const Settings<TumbleAttitude::Params>& attitude_tumble_settings();

/// Estimates one attitude per sample of the recording. On a rig, the filter uses the primary IMU, whose clipped rates
/// are replaced by recovered rates. On a sphere, the filter uses all IMUs, merged into one. The status is the first
/// error of the sensor records or of the filter. After an error, the estimate contains the earlier attitudes.
Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters);

/// Reports how long the inclination is unknown: twice its standard deviation exceeds 1 rad. The report is a failed
/// health check and the health value `attitude_unknown_s`. An IMU gap during a tumble can make the inclination unknown.
void report_unknown_attitude(Estimate& estimate);

}  // namespace tumble::scenarios
