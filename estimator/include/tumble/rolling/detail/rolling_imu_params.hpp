// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// A prior standard deviation of 0 marks an exact quantity.
struct RollingPriorParams {
  double tilt_sigma_rad = 6e-3;
  static constexpr double kVelocitySigma_m_s = 2e-3;
  double gyro_bias_sigma_rad_s = 8.7e-4;  ///< 0.05 deg/s
  double accel_bias_sigma_m_s2 = 0.04;
  double accel_scale_sigma = 3.5e-3;  ///< of each entry of the accelerometer's scale and misalignment matrix
  double gyro_scale_sigma = 2.5e-3;
  double accel_delay_sigma_s = 3e-3;  ///< delay of the accelerometer relative to the gyro

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad,
          {"tilt_sigma_rad", "rad", 0.0, 1e3, "prior standard deviation of the tilt from the first sample",
           ParameterAudience::common_use});
    visit(p.gyro_bias_sigma_rad_s, {"gyro_bias_sigma_rad_s", "rad/s", 0.0, 1e3,
                                    "prior standard deviation of the gyro bias", ParameterAudience::common_use});
    visit(p.accel_bias_sigma_m_s2,
          {"accel_bias_sigma_m_s2", "m/s^2", 0.0, 1e3, "prior standard deviation of the accelerometer bias",
           ParameterAudience::common_use});
    visit(p.accel_scale_sigma,
          {"accel_scale_sigma", "1", 0.0, 1e3,
           "prior standard deviation of each entry of the accelerometer's scale and misalignment"});
    visit(p.gyro_scale_sigma, {"gyro_scale_sigma", "1", 0.0, 1e3,
                               "prior standard deviation of each entry of the gyro's scale and misalignment"});
    visit(p.accel_delay_sigma_s, {"accel_delay_sigma_s", "s", 0.0, 1e3,
                                  "prior standard deviation of the accelerometer's delay relative to the gyro"});
  }
};

struct RollingImuNoiseParams {
  double attitude_walk_rad_sqrts = 1e-4;  ///< 0.006 deg/sqrt(s)
  double rate_error_sqrts = 6e-4;         ///< angle random walk per rad/s of rotation
  static constexpr double kVelocityWalk_m_s_sqrts = 6e-3;
  double gyro_bias_walk_rad_s_sqrts = 1.7e-5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.attitude_walk_rad_sqrts, {"attitude_walk_rad_sqrts", "rad/sqrt(s)", 1e-12, 1e3, "angle random walk"});
    visit(p.rate_error_sqrts, {"rate_error_sqrts", "sqrt(s)", 1e-12, 1e3, "angle random walk per rad/s of rate"});
    visit(p.gyro_bias_walk_rad_s_sqrts,
          {"gyro_bias_walk_rad_s_sqrts", "rad/s/sqrt(s)", 1e-12, 1e3, "random walk of the gyro bias"});
  }
};

struct RollingSaturationParams {
  /// Standard deviation of rates that ImuMerge recovered from saturation. A rate counts as recovered if it is beyond
  /// the gyro's range and has no clip flag. Without a value, ImuMerge recovers no rates.
  std::optional<double> recovered_rate_sigma_rad_s = {};
  /// A short impact may saturate the accelerometer within a sample although the mean reading is below the range. This
  /// value is the standard deviation of the resulting error, relative to the specific force. It applies to readings
  /// above 0.6 of the range, and decreases to zero at 0.3 of the range.
  double subsample_saturation_ratio = 0.25;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.subsample_saturation_ratio, {"subsample_saturation_ratio", "1", 0.0, 10.0,
                                         "standard deviation of the force deficit due to saturation shorter than a "
                                         "sample, as a share of the specific force"});
  }
};

/// Limits of gaps between IMU readings. In a gap, the specific force is unknown, and RollingFilter interpolates the
/// rate linearly.
struct RollingGapParams {
  static constexpr double kGapMinDuration_s = 0.06;  ///< a longer time between two readings is a gap
  static constexpr double kGapMax_s = 1.0;           ///< a longer gap ends the run
};

}  // namespace tumble
