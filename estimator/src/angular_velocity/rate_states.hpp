// SPDX-License-Identifier: BSD-3-Clause
// Results of RateSmoother for each sample.
#pragma once

#include <span>
#include <vector>

#include "rate_readings.hpp"
#include "rate_rounds.hpp"

namespace tumble {

/// Computes rates and covariances at the samples. The covariances include the uncertainty of sensor errors,
/// calibration, and a delay common to both triads (rate_smoother.md). Rates refer to the gyro's time. For a slow gyro,
/// interpolated readings are used where they are better than white jerk. Sets the numbers of recovered, bounded,
/// unusable and flight samples in `health`, which already contains the results of fit_rounds(). O(N), times the number
/// of samples within a shared delay.
std::vector<RateState> rate_states(const RateSmoother::Params& params, std::span<const ImuSample> samples,
                                   const RateReadings& readings, const RateFit& fit, RateReport& health);

}  // namespace tumble
