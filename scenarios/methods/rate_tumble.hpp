// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Parameters of the smoother for an IMU: what its record states (lever arm, noise, ranges) and `parameters`, which
/// hold those of tumble_rate_parameters().
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const sim::Values& parameters);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
