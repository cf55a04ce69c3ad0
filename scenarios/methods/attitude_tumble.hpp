// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"

/// The method attitude/tumble, for those who feed it with other readings.
namespace tumble::scenarios {

/// Parameters of the filter, with the library's own defaults and bounds.
std::span<const sim::Parameter> attitude_tumble_parameters();

/// One attitude per sample: of the primary IMU, whose clipped rates are recovered first; of the body on a sphere, all
/// of its IMUs as one. Trouble: that of the records and of the filter; the attitudes before it stay.
Estimate run_attitude_tumble(const sim::Sensors& sensors, const sim::Values& parameters);

}  // namespace tumble::scenarios
