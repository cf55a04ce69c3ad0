// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/tumble_attitude.hpp"

/// The method attitude/tumble, for those who feed it with other readings.
namespace tumble::scenarios {

/// Parameters of the filter, with the library's own defaults.
const Settings<TumbleAttitude::Params>& attitude_tumble_settings();

/// One attitude per sample: of the primary IMU, whose clipped rates are recovered first; of the body on a sphere, all
/// of its IMUs as one. Trouble: that of the records and of the filter; the attitudes before it stay.
Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters);

/// Puts into the doubts for how long an estimate's inclination is not known to half a radian (two deviations within a
/// quarter of a turn): after a gap of the IMU in a tumble, say (`attitude_unknown_s`).
void tell_unknown_attitude(Estimate& estimate);

}  // namespace tumble::scenarios
