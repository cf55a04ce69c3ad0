// SPDX-License-Identifier: BSD-3-Clause
// rate_rounds.hpp repeats the optimisation of RateSmoother to estimate the sensor errors.
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

/// Repeats the optimisation, each time with readings corrected by the last estimated sensor errors. A linear correction
/// follows at the end. If the calibration changes by more than its uncertainty and the sensor errors allow, the
/// optimisation has classified contact as flight. The optimisation then restarts with the other accelerometer delay
/// (assumed, or estimated from impacts). If the calibration still changes too much, the function fixes the calibration
/// at its prior.
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
