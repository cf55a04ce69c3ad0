// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct FlightRateParams {
  double sigma_m_s2 = 0.02;         ///< error of the specific force besides noise (drag, bias in motion)
  double euler_sigma_rad_s2 = 0.3;  ///< error of the angular acceleration from Euler's equation without torque
  static constexpr double kJerkPsd_rad2_s5 = 1e4;  ///< power spectral density of the white angular jerk
  static constexpr double kThreshold = 5.0;  ///< a sample with larger residuals, in standard deviations, is contact

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s2, {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0,
                         "standard deviation of the force error of the flight model", ParameterRank::common_use});
    visit(p.euler_sigma_rad_s2,
          {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6,
           "standard deviation of the angular acceleration that Euler's equation without torque does not explain",
           ParameterRank::common_use});
  }
};

struct ContactRateParams {
  /// angular acceleration that a contact force causes [rad/s^2 per m/s^2]
  static constexpr double kGain_rad_m = 4.0;
  /// factor on the standard deviation of rates during impacts, whose errors are not Gaussian
  static constexpr double kSigmaFactor = 1.3;
  /// Largest angular acceleration perpendicular to a contact force, per unit of specific force.
  static constexpr double kLever_rad_m = 5.0;
  /// Ratio of the angular accelerations about a contact force and perpendicular to the contact force.
  static constexpr double kTwistRatio = 0.3;
  /// standard deviation of the unknown contact force, relative to the specific force
  static constexpr double kForceShare = 1.0;
};

struct AngularRateModelExpertParams {
  /// correlation time of the model errors of force, torque and rate
  static constexpr double kModelError_s = 0.01;
  /// standard deviation of the rate at rest per sample, including vibration and false detections of rest
  static constexpr double kRestSigma_rad_s = 0.01;
  SensorErrorPriors error_priors = {};  ///< uncertainty of AngularRateModelParams::errors
  /// relative scale and misalignment error of the accelerometer
  static constexpr double kAccelScaleError = 1e-3;
  /// Uncertainty of a reading's time due to the gyro's bandwidth and clock.
  static constexpr double kGyroTimeSigma_s = 2.5e-4;
  static constexpr double kRailSigma_rad_s = 0.05;  ///< standard deviation of the lower bound from a clipped reading
  FlightRateParams flight = {};
  ContactRateParams contact = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.flight);
    visit.group("error_sizes_", p.error_priors);
  }
};

}  // namespace tumble
