// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/sensor_errors.hpp"
#include "tumble/common/parameters.hpp"

/// Groups of RateModelParams::Expert.
namespace tumble {

/// What readings are off by beside their noise.
struct RateReadingParams {
  /// Scale and misalignment of the accelerometer, as a share of the force.
  double accel_scale_error = 1e-3;
  /// What a gyro's bandwidth and its clock leave open of the time of a reading (a first-order low-pass at 415 Hz is
  /// 0.38 ms late): counted in the covariance, times the angular acceleration.
  double gyro_time_sigma_s = 2.5e-4;
  double rail_sigma_rad_s = 0.05;  ///< softness of the bound that a clipped reading is

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_scale_error, {"accel_scale_error", "1", 0.0, 1.0,
                                "scale and misalignment error of the accelerometer, as a share of the force"});
    visit(p.gyro_time_sigma_s, {"gyro_time_sigma_s", "s", 0.0, 0.1,
                                "standard deviation of the time of a gyro reading, from bandwidth and clock"});
    visit(p.rail_sigma_rad_s,
          {"rail_sigma_rad_s", "rad/s", 1e-6, 10.0, "standard deviation of the bound given by a clipped reading"});
  }
};

/// A body that flies: no force but at its position on the rig, no torque.
struct RateFlightParams {
  double sigma_m_s2 = 0.02;  ///< what the model misses of the specific force (drag, bias in motion), besides noise
  double euler_sigma_rad_s2 = 0.3;  ///< what Euler's equation without torque misses of the angular acceleration
  double jerk_psd_rad2_s5 = 1e4;    ///< density of the white angular jerk
  double threshold = 5.0;           ///< a sample whose residuals exceed this many standard deviations counts as contact

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s2, {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0,
                         "standard deviation of the force error of the flight model", Rank::first});
    visit(p.euler_sigma_rad_s2, {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6,
                                 "standard deviation of the error of Euler's equation without torque", Rank::first});
    visit(p.jerk_psd_rad2_s5, {"jerk_psd_flight_rad2_s5", "rad^2/s^5", 1.0, 1e12,
                               "power spectral density of the angular jerk in flight", Rank::first});
    visit(p.threshold,
          {"flight_threshold", "1", 1.0, 100.0,
           "flight residual, in standard deviations, above which a sample counts as contact", Rank::first});
  }
};

/// A body that is struck: a force that nobody knows.
struct RateContactParams {
  /// The jerk grows by what the force can do to the angular acceleration: rad/s^2 per m/s^2 of specific force that the
  /// flight model cannot explain.
  double gain_rad_m = 4.0;
  /// Impacts are no Gaussian noise: what a fit through one claims to know is widened by this factor.
  double sigma_factor = 1.3;
  /// Euler's equation: a force F turns the body across itself, by up to about this times |F| (mass times distance of
  /// the contact over a third of the trace of the inertia) ....
  double lever_rad_m = 5.0;
  /// ... and about its own direction by a share of that (several contacts, a contact that moves in a window).
  double twist_share = 0.3;
  /// The unknown force is taken for zero with a standard deviation of this times itself (a prior that is flat in its
  /// logarithm has 0.58); 0: nothing is assumed of it.
  double force_share = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gain_rad_m,
          {"contact_gain_rad_m", "rad/m", 0.0, 1e3, "angular acceleration per contact force", Rank::first});
    visit(p.sigma_factor, {"contact_sigma_factor", "1", 1.0, 10.0,
                           "factor that widens the standard deviations of rates fitted through an impact"});
    visit(p.lever_rad_m, {"contact_lever_rad_m", "rad/m", 0.0, 1e3,
                          "largest angular acceleration perpendicular to a contact force, per force"});
    visit(p.twist_share, {"contact_twist_share", "1", 0.0, 1.0,
                          "angular acceleration about the contact force, as a share of the perpendicular one"});
    visit(p.force_share,
          {"contact_force_share", "1", 0.0, 1e3,
           "standard deviation of the unknown contact force, as a share of the force; 0: no assumption"});
  }
};

/// What few need of RateModelParams, by meaning. Fields bear the names that they have in tables and on command lines.
struct RateModelExpertParams {
  /// What the model misses of a force, a torque or a rate lasts so long: samples that come faster say it once between
  /// them, and their noise alone averages out.
  double model_error_s = 0.01;
  /// A body at rest still trembles, and rest may be found where there is none: deviation of its rate from zero, taken
  /// anew with each sample.
  double rest_sigma_rad_s = 0.01;
  SensorErrorSizes error_sizes = {};  ///< what is left open of RateModelParams::errors
  RateReadingParams readings = {};
  RateFlightParams flight = {};
  RateContactParams contact = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.flight);
    visit.group("", p.contact);
    visit(p.model_error_s,
          {"model_error_s", "s", 1e-6, 1.0, "correlation time of model errors of force, torque and rate"});
    visit.group("", p.readings);
    visit.group("error_sizes_", p.error_sizes);
    visit(p.rest_sigma_rad_s, {"rest_sigma_rad_s", "rad/s", 1e-9, 10.0, "standard deviation of the rate at rest"});
  }
};

}  // namespace tumble
