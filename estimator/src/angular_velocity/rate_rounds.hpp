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
/// follows at the end. If an optimisation mistakes contact for flight and thereby changes the calibration, the function
/// fixes the calibration at its prior. Contact was mistaken for flight if the calibration changes by more than its
/// uncertainty and the sensor errors allow. Before that, the first optimisation repeats with the other accelerometer
/// delay (assumed, or estimated from impacts).
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
