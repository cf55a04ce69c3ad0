// SPDX-License-Identifier: BSD-3-Clause
// rate_states.hpp computes the results of RateSmoother for each sample.
#pragma once

#include <span>
#include <vector>

#include "rate_readings.hpp"
#include "rate_rounds.hpp"

namespace tumble {

/// Computes rates and covariances at the samples. Cost: O(N), times the number of samples within a common delay. The
/// covariances include the uncertainty of sensor errors, of the calibration, and of a delay common to gyro and
/// accelerometer (rate_smoother.md). The rates refer to the gyro's time. For a gyro that is slower than its log,
/// interpolated readings are used where the interpolation is more accurate than the prior of white jerk. The function
/// sets the numbers of recovered, bounded, unusable and flight samples in `health`, which already contains the results
/// of fit_rounds().
std::vector<RateState> rate_states(const RateSmoother::Params& params, std::span<const ImuSample> samples,
                                   const RateReadings& readings, const RateFit& fit, RateReport& health);

}  // namespace tumble
