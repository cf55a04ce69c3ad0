// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

/// A prior standard deviation of 0 marks an exact quantity.
struct RollingPriorParams {
  double tilt_sigma_rad = 6e-3;
  double velocity_sigma_m_s = 2e-3;
  double gyro_bias_sigma_rad_s = 8.7e-4;  ///< 0.05 deg/s
  double accel_bias_sigma_m_s2 = 0.04;
  double accel_scale_sigma = 3.5e-3;  ///< each entry of the scale and misalignment matrix
  double gyro_scale_sigma = 2.5e-3;
  double accel_delay_sigma_s = 3e-3;  ///< delay of the accelerometer relative to the gyro
  /// minimum rate of the first sample for a start in motion, with uncertain attitude and velocity
  double start_rate_rad_s = 0.1;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad, {"tilt_sigma_rad", "rad", 0.0, 1e3,
                             "prior standard deviation of the tilt from the first sample", FieldRank::basic});
    visit(p.velocity_sigma_m_s,
          {"velocity_sigma_m_s", "m/s", 0.0, 1e3, "prior standard deviation of the initial velocity"});
    visit(p.gyro_bias_sigma_rad_s,
          {"gyro_bias_sigma_rad_s", "rad/s", 0.0, 1e3, "prior standard deviation of the gyro bias", FieldRank::basic});
    visit(p.accel_bias_sigma_m_s2, {"accel_bias_sigma_m_s2", "m/s^2", 0.0, 1e3,
                                    "prior standard deviation of the accelerometer bias", FieldRank::basic});
    visit(p.accel_scale_sigma,
          {"accel_scale_sigma", "1", 0.0, 1e3,
           "prior standard deviation of each entry of the accelerometer's scale and misalignment"});
    visit(p.gyro_scale_sigma, {"gyro_scale_sigma", "1", 0.0, 1e3,
                               "prior standard deviation of each entry of the gyro's scale and misalignment"});
    visit(p.accel_delay_sigma_s, {"accel_delay_sigma_s", "s", 0.0, 1e3,
                                  "prior standard deviation of the accelerometer's delay relative to the gyro"});
    visit(p.start_rate_rad_s,
          {"start_rate_rad_s", "rad/s", 1e-12, 10.0, "minimum rate of the first sample for a start in motion"});
  }
};

struct RollingImuNoiseParams {
  double attitude_walk_rad_sqrts = 1e-4;  ///< 0.006 deg/sqrt(s)
  double rate_error_sqrts = 6e-4;         ///< angle random walk per rad/s of rotation
  double velocity_walk_m_s_sqrts = 6e-3;
  double velocity_walk_per_rate2_sqrts =
      4e-5;  ///< additional velocity random walk per (rad/s)^2: errors of large forces
  double gyro_bias_walk_rad_s_sqrts = 1.7e-5;
  double accel_bias_walk_m_s2_sqrts = 2e-3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.attitude_walk_rad_sqrts, {"attitude_walk_rad_sqrts", "rad/sqrt(s)", 1e-12, 1e3, "angle random walk"});
    visit(p.rate_error_sqrts, {"rate_error_sqrts", "sqrt(s)", 1e-12, 1e3, "angle random walk per rad/s of rate"});
    visit(p.velocity_walk_m_s_sqrts, {"velocity_walk_m_s_sqrts", "m/s/sqrt(s)", 1e-12, 1e3, "velocity random walk"});
    visit(p.velocity_walk_per_rate2_sqrts,
          {"velocity_walk_per_rate2_sqrts", "m/s/sqrt(s)/(rad/s)^2", 0.0, 1e3,
           "additional velocity random walk per (rad/s)^2 of rate, caused by sensor errors under large forces"});
    visit(p.gyro_bias_walk_rad_s_sqrts,
          {"gyro_bias_walk_rad_s_sqrts", "rad/s/sqrt(s)", 1e-12, 1e3, "random walk of the gyro bias"});
    visit(p.accel_bias_walk_m_s2_sqrts,
          {"accel_bias_walk_m_s2_sqrts", "m/s^2/sqrt(s)", 1e-12, 1e3, "random walk of the accelerometer bias"});
  }
};

struct RollingRailParams {
  double clipped_rate_sigma_rad_s = 5.0;
  /// standard deviation of rates beyond the gyro's range that ImuMerge recovered; 0: no recovered rates
  double recovered_rate_sigma_rad_s = 0.0;
  double clipped_force_sigma_m_s2 = 4.0;
  /// Standard deviation of the force deficit due to saturation shorter than a sample, relative to the force. The full
  /// standard deviation applies above 0.6 of the range, and 0 below 0.3 of the range.
  double subsample_saturation_ratio = 0.25;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.clipped_rate_sigma_rad_s, {"clipped_rate_sigma_rad_s", "rad/s", 1e-12, 1e3,
                                       "standard deviation of the saturation deficit of a clipped rate"});
    visit(p.recovered_rate_sigma_rad_s,
          {"recovered_rate_sigma_rad_s", "rad/s", 0.0, 1e3,
           "standard deviation of a clipped rate that was recovered from several IMUs; 0: no recovery"});
    visit(p.clipped_force_sigma_m_s2, {"clipped_force_sigma_m_s2", "m/s^2", 1e-12, 1e3,
                                       "standard deviation of the force beyond the saturation limit"});
    visit(p.subsample_saturation_ratio,
          {"subsample_saturation_ratio", "1", 0.0, 10.0,
           "standard deviation of the force deficit due to saturation shorter than a sample, as a share of the force"});
  }
};

/// Without readings for longer than gap_min_duration_s, the rate is interpolated linearly, and the force is unknown.
struct RollingGapParams {
  double gap_min_duration_s = 0.06;
  double gap_max_s = 1.0;  ///< a longer gap ends the run
  double gap_acceleration_rad_s2 = 15.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gap_min_duration_s,
          {"gap_min_duration_s", "s", 1e-9, 1.0,
           "minimum time between two readings that counts as a gap, in which the force is unknown"});
    visit(p.gap_max_s,
          {"gap_max_s", "s", 1e-9, 1.0, "maximum time between two samples; a longer gap ends the run with an error"});
    visit(p.gap_acceleration_rad_s2,
          {"gap_acceleration_rad_s2", "rad/s^2", 1e-12, 1e4,
           "standard deviation of the angular acceleration during a gap, about the linearly interpolated rate"});
  }
};

}  // namespace tumble
