// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rate_descent.hpp"

namespace tumble {

struct AngularRateFit {
  AngularRateFit(std::span<const AngularRateObservation> observations, const AngularRateModel& first)
      : solution{{}, {}, {}, GaussNewtonRateStep(observations)}, model(first) {}

  RateSolution solution;
  AngularRateModel model;
  GaussNewtonRateStep::SensorErrorDerivatives error_derivatives;
};

/// Optimises repeatedly, each time with readings corrected by the last estimated sensor errors. If the calibration
/// changes by more than its standard deviations, contact was classified as flight, and the optimisation restarts with
/// another accelerometer delay. If the restart also fails, the calibration is held at its prior.
Status fit_rounds(const AngularRateSmoother::Params& params, const AngularRateModelParams& known,
                  std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                  std::span<AngularRateObservation> observations, AngularRateFit& fit, AngularRateReport& health);

}  // namespace tumble
