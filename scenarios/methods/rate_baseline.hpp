// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

/// The initial saturation limits are the measurement ranges of the IMU's data sheet, where 0 means unknown.
SaturationLimitDetector::Params stated_rails(const sim::ImuRecord& record);

Estimate run_clipped_baseline(const Settings<baselines::ClippedBaseline::Params>& settings, const sim::Sensors& sensors,
                              const sim::Values& parameters);

}  // namespace tumble::scenarios
