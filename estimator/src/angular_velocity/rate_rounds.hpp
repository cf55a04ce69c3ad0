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

/// Optimises repeatedly, each time with readings corrected by the last estimated sensor errors. If the calibration
/// changes by more than its standard deviations, contact was classified as flight, and the optimisation restarts with
/// another accelerometer delay. If the restart also fails, the calibration is held at its prior.
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
