// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

/// Returns the saturation limits that follow from the measurement ranges of the IMU. A range of 0 is unknown.
RailDetector::Params stated_rails(const sim::ImuRecord& record);

/// Runs ClippedBaseline on the primary IMU, with the noise and ranges of the IMU's data sheet.
Estimate run_clipped_baseline(const Settings<baselines::ClippedBaseline::Params>& settings, const sim::Sensors& sensors,
                              const sim::Values& parameters);

}  // namespace tumble::scenarios
