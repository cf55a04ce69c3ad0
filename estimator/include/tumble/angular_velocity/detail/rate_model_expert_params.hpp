// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct FlightRateParams {
  double sigma_m_s2 =
      0.02;  ///< standard deviation of the specific force in flight, besides noise: air drag, accelerometer errors
  double euler_sigma_rad_s2 = 0.3;  ///< error of the angular acceleration from Euler's equation without torque
  static constexpr double kJerkPsd_rad2_s5 = 1e4;
  static constexpr double kThreshold =
      5.0;  ///< a sample with larger flight residuals, in standard deviations, is in contact

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s2, {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0,
                         "standard deviation of the force error of the flight model", ParameterAudience::common_use});
    visit(p.euler_sigma_rad_s2,
          {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6,
           "standard deviation of the angular acceleration that Euler's equation without torque does not explain",
           ParameterAudience::common_use});
  }
};

struct ContactRateParams {
  /// assumed angular acceleration per unit of contact force [rad/s^2 per m/s^2]
  static constexpr double kGain_rad_m = 4.0;
  /// factor on the standard deviation of rates during impacts, because their errors are not Gaussian
  static constexpr double kSigmaFactor = 1.3;
  /// Largest angular acceleration about axes perpendicular to a contact force, per unit of specific force.
  static constexpr double kLever_rad_m = 5.0;
  /// Ratio of the angular acceleration about the direction of a contact force to the angular acceleration perpendicular
  /// to this direction.
  static constexpr double kTwistRatio = 0.3;
  /// standard deviation of the unknown contact force, relative to the specific force
  static constexpr double kForceShare = 1.0;
};

struct AngularRateModelExpertParams {
  /// correlation time of the model errors of specific force, torque and rate
  static constexpr double kModelError_s = 0.01;
  /// standard deviation of the zero-rate measurement per sample at rest; covers vibration and false detections of rest
  static constexpr double kRestSigma_rad_s = 0.01;
  SensorErrorPriors error_priors = {};
  /// relative scale and misalignment error of the accelerometer
  static constexpr double kAccelScaleError = 1e-3;
  /// Standard deviation of the time of a gyro reading, due to the gyro's bandwidth and clock.
  static constexpr double kGyroTimeSigma_s = 2.5e-4;
  static constexpr double kRailSigma_rad_s =
      0.05;  ///< standard deviation of the lower bound that a clipped reading gives
  FlightRateParams flight = {};
  ContactRateParams contact = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.flight);
    visit.group("error_sizes_", p.error_priors);
  }
};

}  // namespace tumble
