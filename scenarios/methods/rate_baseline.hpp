// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

/// The rails of a record as its data sheet states them; a range of 0 says nothing.
RailDetector::Params stated_rails(const sim::ImuRecord& record);

/// The gyro as it is, with the axes named that are at their rail. One RateState per sample.
Status railed_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);

/// Runs one of the library's baselines on the primary IMU, with its data sheet's noise and ranges.
Estimate run_clipped_baseline(const Settings<baselines::ClippedBaseline::Params>& settings, const sim::Sensors& sensors,
                              const sim::Values& parameters);

}  // namespace tumble::scenarios
