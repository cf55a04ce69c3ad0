// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble::scenarios {

const Settings<SaturationAwareRateEstimator::Params>& saave_settings();
Settings<SaturationAwareRateEstimator::Params> other_saave_settings(std::span<const sim::Parameter> others);

/// On error, `out` is empty.
Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<SaturationAwareRateEstimator::Params>& settings, const sim::Values& parameters,
                   std::vector<AngularRateState>& out);

}  // namespace tumble::scenarios
