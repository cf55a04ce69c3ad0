// SPDX-License-Identifier: BSD-3-Clause
// Repeated descents of RateSmoother that estimate sensor errors.
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

/// Repeats the descent with readings corrected for the sensor errors found by the previous one, followed by a linear
/// correction. If a descent mistakes contact for flight with another calibration, the calibration is fixed at its
/// prior. The criterion is that its constants move further than their uncertainty or sensor errors allow. Before that,
/// the first descent is repeated with the other delay (assumed or guessed).
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
