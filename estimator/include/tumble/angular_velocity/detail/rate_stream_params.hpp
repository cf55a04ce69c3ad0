// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>

#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rate_stream_expert_params.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct AngularRateStreamParams {
  /// The prior standard deviations of accelerometer bias (2 mg) and inertia are smaller than in AngularRateModelParams,
  /// because AngularRateStream reports rates before much data has arrived.
  AngularRateModelParams model = {.accel_bias_sigma_m_s2 = 0.02, .inertia_sigma = 0.15};
  SaturationLimitDetector::Params saturation_detector = {};
  double period_s = 0.01;
  double lag_s = 0.2;                        ///< length of the window; [2 period_s, lag_max_s()]
  double calibration_mahalanobis_max = 1.5;  ///< a larger distance of the rig constants from their prior resets them
  static constexpr double kGapMax_s = 1.0;
  double step_s = 0.005;  ///< time between two Gauss-Newton steps; 0: a step after each sample

  /// Sensor errors from an earlier run, which replace model.errors. Without them, AngularRateStream subtracts
  /// model.errors and estimates the covariance of the remaining errors.
  std::shared_ptr<const KnownSensorErrors> calibrated_errors;

  using Expert = AngularRateStreamExpertParams;
  Expert expert = {};

  /// longest permitted lag: the duration of 4096 samples, but at most 10 s
  double lag_max_s() const { return std::min(10.0, 4096.0 * period_s); }

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.model);
    visit(p.period_s, {"period_s", "s", 1e-5, 1.0, "nominal time between samples"});
    visit(p.lag_s, {"lag_s", "s", 2e-5, 10.0,
                    "age of a sample when its estimate is reported; a larger value adds delay and makes the estimate "
                    "more accurate",
                    ParameterAudience::common_use});
    visit(p.calibration_mahalanobis_max, {"calibration_mahalanobis_max", "1", 0.1, 1e6,
                                          "maximum Mahalanobis distance between the estimated rig constants and their "
                                          "prior; a larger distance resets the calibration to the prior",
                                          ParameterAudience::common_use});
    visit(p.step_s, {"step_s", "s", 0.0, 0.1,
                     "time between two Gauss-Newton steps, rounded down to whole samples; a larger value costs less "
                     "computing time; 0: one step per sample"});
    visit.group("", p.expert);
  }
};

}  // namespace tumble
