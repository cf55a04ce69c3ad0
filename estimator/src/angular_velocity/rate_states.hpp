// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "rate_readings.hpp"
#include "rate_rounds.hpp"

namespace tumble {

/// Computes angular rates and covariances at the times of the gyro's readings. The covariances include the uncertainty
/// of sensor errors, calibration, and the common delay of gyro and accelerometer (rate_smoother.md). If the log repeats
/// gyro readings, interpolated readings replace less accurate estimates.
std::vector<AngularRateState> rate_states_of_recording(const AngularRateSmoother::Params& params,
                                                       std::span<const ImuSample> samples,
                                                       const AngularRateReadings& readings, const AngularRateFit& fit,
                                                       AngularRateReport& health);

}  // namespace tumble
