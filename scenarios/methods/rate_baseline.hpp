// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// The rails of a record as its data sheet states them; a range of 0 says nothing.
RailDetector::Params stated_rails(const sim::ImuRecord& record);

/// The named switch of families that were published with rails upright on each axis, and run so by default.
inline constexpr sim::Parameter kTiltedRails = {
    "tilted_rails", 0.0, 0.0, 1.0, "1", "1: judge clipping by the elements' tilted planes as our methods do"};

/// Runs one of the library's baselines on the primary IMU, with its data sheet's noise and ranges.
Estimate run_clipped_baseline(baselines::ClippedBaseline::Params params, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
