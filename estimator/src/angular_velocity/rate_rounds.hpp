// SPDX-License-Identifier: BSD-3-Clause
// rate_rounds.hpp repeats the optimisation of RateSmoother to estimate sensor errors.
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

/// Repeats the optimisation with readings corrected for the sensor errors of the previous optimisation, and finally
/// applies a linear correction. If an optimisation mistakes contact for flight by changing the calibration, the
/// calibration is fixed at its prior. Contact was mistaken for flight if the constants move further than their
/// uncertainty or sensor errors allow. Before the calibration is fixed, the first optimisation is repeated with the
/// alternative delay (assumed or guessed).
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
