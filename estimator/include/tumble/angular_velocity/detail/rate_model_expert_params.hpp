// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// errors of IMU readings other than noise
struct RateReadingParams {
  /// relative scale and misalignment error of the accelerometer
  double accel_scale_error = 1e-3;
  /// Uncertainty of a reading's time due to the gyro's bandwidth and clock.
  double gyro_time_sigma_s = 2.5e-4;
  double rail_sigma_rad_s = 0.05;  ///< standard deviation of the lower bound from a clipped reading

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_scale_error, {"accel_scale_error", "1", 0.0, 1.0,
                                "scale and misalignment error of the accelerometer, as a share of the specific force"});
    visit(p.gyro_time_sigma_s,
          {"gyro_time_sigma_s", "s", 0.0, 0.1,
           "standard deviation of the time stamp of a gyro reading, caused by bandwidth and clock"});
    visit(p.rail_sigma_rad_s, {"rail_sigma_rad_s", "rad/s", 1e-6, 10.0,
                               "standard deviation of the bound that a clipped reading sets on the rate"});
  }
};

struct RateFlightParams {
  double sigma_m_s2 = 0.02;         ///< error of the specific force besides noise (drag, bias in motion)
  double euler_sigma_rad_s2 = 0.3;  ///< error of the angular acceleration from Euler's equation without torque
  double jerk_psd_rad2_s5 = 1e4;    ///< power spectral density of the white angular jerk
  double threshold = 5.0;           ///< a sample with larger residuals, in standard deviations, is contact

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s2, {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0,
                         "standard deviation of the force error of the flight model", FieldRank::basic});
    visit(p.euler_sigma_rad_s2,
          {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6,
           "standard deviation of the angular acceleration that Euler's equation without torque does not explain",
           FieldRank::basic});
    visit(p.jerk_psd_rad2_s5, {"jerk_psd_flight_rad2_s5", "rad^2/s^5", 1.0, 1e12,
                               "power spectral density of the angular jerk in flight", FieldRank::basic});
    visit(p.threshold,
          {"flight_threshold", "1", 1.0, 100.0,
           "flight residual, in standard deviations, above which a sample counts as contact", FieldRank::basic});
  }
};

struct RateContactParams {
  /// angular acceleration that a contact force causes [rad/s^2 per m/s^2]
  double gain_rad_m = 4.0;
  /// factor on the standard deviation of rates during impacts, whose errors are not Gaussian
  double sigma_factor = 1.3;
  /// Largest angular acceleration perpendicular to a contact force, per unit of specific force.
  double lever_rad_m = 5.0;
  /// Ratio of the angular accelerations about a contact force and perpendicular to the contact force.
  double twist_ratio = 0.3;
  /// standard deviation of the unknown contact force, relative to the specific force; 0: no assumption
  double force_share = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gain_rad_m,
          {"contact_gain_rad_m", "rad/m", 0.0, 1e3,
           "standard deviation of the angular acceleration, per unit of specific force that a contact causes",
           FieldRank::basic});
    visit(p.sigma_factor,
          {"contact_sigma_factor", "1", 1.0, 10.0, "factor on the standard deviations of rates during an impact"});
    visit(p.lever_rad_m,
          {"contact_lever_rad_m", "rad/m", 0.0, 1e3,
           "largest angular acceleration about an axis perpendicular to a contact force, per unit of specific force"});
    visit(p.twist_ratio,
          {"contact_twist_ratio", "1", 0.0, 1.0,
           "angular acceleration about the axis of the contact force, as a share of the angular acceleration about "
           "perpendicular axes"});
    visit(p.force_share,
          {"contact_force_sigma_ratio", "1", 0.0, 1e3,
           "standard deviation of the unknown contact force, as a share of the specific force; 0: no assumption"});
  }
};

struct RateModelExpertParams {
  /// correlation time of the model errors of force, torque and rate
  double model_error_s = 0.01;
  /// standard deviation of the rate at rest per sample, including vibration and false detections of rest
  double rest_sigma_rad_s = 0.01;
  SensorErrorPriors error_priors = {};  ///< uncertainty of RateModelParams::errors
  RateReadingParams readings = {};
  RateFlightParams flight = {};
  RateContactParams contact = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.flight);
    visit.group("", p.contact);
    visit(p.model_error_s,
          {"model_error_s", "s", 1e-6, 1.0, "correlation time of the model errors of force, torque and rate"});
    visit.group("", p.readings);
    visit.group("error_sizes_", p.error_priors);
    visit(p.rest_sigma_rad_s, {"rest_sigma_rad_s", "rad/s", 1e-9, 10.0, "standard deviation of the rate at rest"});
  }
};

}  // namespace tumble
