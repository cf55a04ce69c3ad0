// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/tumble_attitude.hpp"

/// Declares the method attitude/tumble, also for callers that supply other readings.
namespace tumble::scenarios {

/// Returns the filter's parameters with the library's defaults.
const Settings<TumbleAttitude::Params>& attitude_tumble_settings();

/// Estimates one attitude per sample. On a rig, the filter uses the primary IMU with recovered clipped rates; on a
/// sphere, the filter uses all IMUs merged to one. Errors are those of the records and of the filter; attitudes
/// computed before an error are kept.
Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters);

/// Reports for how long the inclination is unknown to 0.5 rad (2 sigma within a quarter turn), for example after an IMU
/// gap in a tumble. Adds a failed health check and the health value `attitude_unknown_s`.
void report_unknown_attitude(Estimate& estimate);

}  // namespace tumble::scenarios
