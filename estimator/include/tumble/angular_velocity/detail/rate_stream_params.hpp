// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>

#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Until enough free flight has updated the rig constants (lever arm, biases, inertia ratios), reported covariances are
/// increased. Below, n is the number of flight samples so far, each of the duration `model_error_s`.
struct CalibrationInflationParams {
  /// The covariance of the rig constants is multiplied by 1 + covariance / (1 + n / samples), up to the prior
  /// covariance.
  double covariance = 60.0;
  static constexpr double kSamples = 30.0;
  /// In contact, the standard deviation of a clipped rate is at least contact / (1 + n / samples) times the saturation
  /// deficit.
  double contact = 0.5;
  /// In contact, the standard deviation of a clipped rate is at least slopes * d - (estimated saturation deficit). The
  /// deficit d is extrapolated from the slopes of the gyro readings before and after saturation.
  double slopes = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.covariance, {"rig_inflation", "1", 0.0, 1e3,
                         "the covariance of an uncalibrated rig is multiplied by 1 + rig_inflation / (1 + n / "
                         "rig_inflation_samples), with n flight samples of model_error_s each"});
    visit(p.contact,
          {"contact_inflation", "1", 0.0, 10.0,
           "minimum standard deviation of a clipped rate in contact, as a share of the saturation deficit; divided "
           "by 1 + n / rig_inflation_samples after n flight samples"});
    visit(p.slopes,
          {"contact_slopes", "1", 0.0, 10.0,
           "minimum standard deviation of a clipped rate in contact, as a share of the saturation deficit that "
           "the rate's slopes before and after saturation predict"});
  }
};

struct AngularRateStreamExpertParams {
  SaturationPlaneFinder::Params gyro_planes = {};  ///< a missing range is taken from AngularRateStreamParams
  SaturationPlaneFinder::Params accel_saturation_planes = SaturationPlaneFinder::Params::defaults_for_accelerometer();
  RestDetector::Params rest_detector = {};
  static constexpr double kInitialThresholdFactor =
      8.0;  ///< factor on FlightRateParams::kThreshold for a new clipped sample; halved in each step
  static constexpr double kStepMax_rad_s = 10.0;
  int bound_hard_steps = 3;  ///< steps until a sample in contact uses Gaussian approximations of lower bounds
  static constexpr double kBoundDamping = 0.5;     ///< weight of a new lower bound in each step
  static constexpr std::size_t kFlightRunMin = 6;  ///< shorter flights, in samples, do not update the rig constants
  CalibrationInflationParams inflation = {};
  /// prior probability of an uncalibrated IMU; 0: the IMU is assumed to match its data sheet
  double uncalibrated = 0.3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("planes_", p.gyro_planes);
    visit.group("accel_planes_", p.accel_saturation_planes);
    visit.group("rests_", p.rest_detector);
    visit(p.bound_hard_steps,
          {"bound_hard_steps", "1", 0, 4096,
           "number of steps after which clipped rates in contact have truncated normal distributions"});
    visit.group("", p.inflation);
    visit(p.uncalibrated,
          {"uncalibrated", "1", 0.0, 0.99, "prior probability that the IMU does not match its data sheet"});
  }
};

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
