// SPDX-License-Identifier: BSD-3-Clause
// The descents of RateSmoother from round to round of what they tell of the device's errors.
#pragma once

#include <span>

#include "rate_descent.hpp"

namespace tumble {

/// A descent with what it was made with.
struct RateFit {
  RateFit(std::span<const RateObservation> observations, const RateModel& first)
      : solution{{}, {}, {}, RateIteration(observations)}, model(first) {}

  RateSolution solution;
  RateModel model;
  RateIteration::Moved moved;
};

/// Descents with readings corrected for the device's errors as the one before has found them, and a last, linear
/// correction. The rig is held to what was known of it where a descent takes contact for flight of another rig: where
/// its constants move further than they or the device's errors allow. The first is made again from the other of two
/// delays, the one assumed and the one guessed, before that is believed.
Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health);

}  // namespace tumble
