// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rate_descent.hpp"

namespace tumble {

struct RateFit {
  RateFit(std::span<const RateObservation> observations, const RateModel& first)
      : solution{{}, {}, {}, RateIteration(observations)}, model(first) {}

  RateSolution solution;
  RateModel model;
  RateIteration::SensorErrorDerivatives moved;
};

/// Optimises repeatedly, each time with readings corrected by the last estimated sensor errors. A calibration that
/// changes by more than its standard deviations indicates that contact was classified as flight. If contact was
/// classified as flight, the optimisation restarts with another accelerometer delay, and finally holds the calibration
/// at its prior.
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
