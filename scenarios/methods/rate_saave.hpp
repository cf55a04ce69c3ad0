// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/saave.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

/// Rates by the published method of Saave, shared by its rate method and the slam chains that use it.
namespace tumble::scenarios {

const Settings<Saave::Params>& saave_settings();
/// Returns the same settings for use next to another stage: parameters with equal names get the prefix `rate_`.
Settings<Saave::Params> saave_settings_beside(std::span<const sim::Parameter> others);

/// Computes one RateState per sample; `out` is empty on error.
Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<Saave::Params>& settings, const sim::Values& parameters, std::vector<RateState>& out);

}  // namespace tumble::scenarios
