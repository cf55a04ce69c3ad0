// SPDX-License-Identifier: BSD-3-Clause
// Repeated optimisations of RateSmoother that estimate sensor errors.
#pragma once

#include <span>

#include "rate_descent.hpp"

namespace tumble {

struct RateFit {
  RateFit(std::span<const RateObservation> observations, const RateModel& first)
      : solution{{}, {}, {}, RateIteration(observations)}, model(first) {}

  RateSolution solution;
  RateModel model;
  RateIteration::Moved moved;
};

/// Repeats the optimisation with readings corrected for the sensor errors found by the previous optimisation, followed
/// by a linear correction. If an optimisation mistakes contact for flight with another calibration, the calibration is
/// fixed at its prior. The criterion is that the constants move further than their uncertainty or sensor errors allow.
/// Before the calibration is fixed, the first optimisation is repeated with the alternative delay (assumed or guessed).
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
