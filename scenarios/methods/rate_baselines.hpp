// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

/// Returns the measurement ranges in the IMU's data sheet as initial saturation limits; 0 means an unknown range.
SaturationLimitDetector::Params stated_rails(const sim::ImuRecord& record);

Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<AngularRateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<AngularRateState>& out);

Settings<SaturationAwareRateEstimator::Params> other_saave_settings(std::span<const sim::Parameter> others);

/// On error, `out` is empty.
Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<SaturationAwareRateEstimator::Params>& settings, const sim::Values& parameters,
                   std::vector<AngularRateState>& out);

}  // namespace tumble::scenarios
