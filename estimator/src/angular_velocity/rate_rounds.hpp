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

/// Optimises repeatedly, and corrects the readings each time by the last estimated sensor errors. If the estimated
/// calibration is too far from its prior, rate_smoother.md (R32), contact was probably classified as free flight, and
/// the optimisation restarts up to two times. The first restart ignores the sensor errors of an earlier run, and the
/// second restart uses another accelerometer delay. If all restarts of the optimisation fail, the calibration is held
/// at its prior.
Status fit_rounds(const AngularRateSmoother::Params& params, const AngularRateModelParams& known,
                  std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                  std::span<AngularRateObservation> observations, AngularRateFit& fit, AngularRateReport& health);

}  // namespace tumble
