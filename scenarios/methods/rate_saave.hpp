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

/// The published rate stage, shared by its method and the slam chains after it.
namespace tumble::scenarios {

const Settings<Saave::Params>& saave_settings();
/// The same beside the parameters of another stage: those that are called alike begin with `rate_`.
Settings<Saave::Params> saave_settings_beside(std::span<const sim::Parameter> others);

/// One RateState per sample; `out` is empty on trouble.
Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<Saave::Params>& settings, const sim::Values& parameters, std::vector<RateState>& out);

}  // namespace tumble::scenarios
