// SPDX-License-Identifier: BSD-3-Clause
// What RateSmoother says of each sample once its descents have ended.
#pragma once

#include <span>
#include <vector>

#include "rate_readings.hpp"
#include "rate_rounds.hpp"

namespace tumble {

/// Rates and covariances at the samples: of the fit, with what remains open of the device's errors, of the rig and of a
/// delay that both triads share (rate_smoother.md); at the gyro's own time; by readings where a slower gyro says more
/// than white jerk between them. Counts in `health` what was recovered, bounded, void and in flight. `health` holds
/// what fit_rounds() tells already. O(N), times the samples within a shared delay where there is one.
std::vector<RateState> rate_states(const RateSmoother::Params& params, std::span<const ImuSample> samples,
                                   const RateReadings& readings, const RateFit& fit, RateReport& health);

}  // namespace tumble
