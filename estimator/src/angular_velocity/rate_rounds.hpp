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

/// Repeats the optimisation with readings corrected by the previous sensor errors, and finally applies a linear
/// correction. If an optimisation mistakes contact for flight and thereby changes the calibration, the function fixes
/// the calibration at its prior. Contact was mistaken for flight if the constants change more than their uncertainty
/// and the sensor errors allow. Before fixing the calibration, the function repeats the first optimisation with the
/// alternative delay (assumed or guessed).
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
