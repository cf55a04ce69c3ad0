// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
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

}  // namespace tumble
