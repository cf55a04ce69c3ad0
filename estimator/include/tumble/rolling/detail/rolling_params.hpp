// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/rolling/detail/rolling_model.hpp"

namespace tumble {

struct RollingContactParams {
  static constexpr double kGripSigma_m_s = 3e-3;  ///< standard deviation of the contact point's velocity while gripping
  static constexpr double kGripSigmaRatio =
      1.5e-3;  ///< additional standard deviation of this velocity, relative to the rolling speed
  static constexpr double kVerticalSigma_m_s = 8e-3;  ///< standard deviation of the vertical velocity on a smooth floor
  /// standard deviation of the vertical velocity on a rough floor, relative to the rolling speed
  static constexpr double kRoughShare = 0.055;
  static constexpr double kSlopeSigma = 0.15;  ///< prior standard deviation of both components of the floor's slope
  static constexpr double kRestVelocitySigma_m_s =
      2e-3;  ///< standard deviation of the mean velocity over a time step at rest
  static constexpr double kRestRateSigma_rad_s =
      3e-3;  ///< standard deviation of the mean rate over a time step at rest
};

struct ContactModeParams {
  double slip_begins_per_s = 0.5;
  static constexpr double kSlipEndsPerS = 2.0;  ///< rate of transitions from slip to grip
  double bump_begins_per_s = 0.3;
  static constexpr double kBumpEndsPerS = 5.0;  ///< rate of transitions from bump to grip
  double incline_begins_per_s = 0.001;          ///< rate of transitions from the level floor to a slope
  static constexpr double kEventShortest_s = 0.06;
  /// RollingEstimate::uncertain is set if a slip or bump increases the horizontal standard deviation of the position by
  /// more than this value.
  static constexpr double kEventSigmaGrowth_m = 0.03;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slip_begins_per_s, {"slip_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to slip",
                                ParameterAudience::common_use});
    visit(p.bump_begins_per_s, {"bump_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to bump",
                                ParameterAudience::common_use});
    visit(p.incline_begins_per_s, {"incline_begins_per_s", "1/s", 1e-12, 1e3,
                                   "rate of transitions from level floor to slope", ParameterAudience::common_use});
  }
};

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

struct RollingExpertParams {
  static constexpr double kNode_s = 0.02;  ///< time between two measurement updates (nodes)
  /// The rest detector processes the mean reading of each time step `kNode_s`. A larger limit of the rate would
  /// increase the drift of a sphere that comes to rest.
  RestDetector::Params rest_detector = {.rate_max_rad_s = 0.0115,
                                        .rate_spread_rad_s = 0.016,
                                        .force_spread_m_s2 = 0.15,
                                        .rest_s = 0.4,
                                        .caller_settings = {.memory_s = 0.1}};
  RollingPriorParams prior = {};
  RollingImuNoiseParams noise = {};
  RollingSaturationParams saturation = {};
  ContactModeParams modes = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("rest_", p.rest_detector);
    visit.group("", p.prior);
    visit.group("", p.noise);
    visit.group("", p.saturation);
    visit.group("", p.modes);
  }
};

struct RollingParams {
  double radius_m = 0.0;        ///< required
  double radius_sigma_m = 0.0;  ///< 0: the radius is exact
  Eigen::Vector3d lever_arm_m =
      Eigen::Vector3d::Zero();  ///< lever arm from the sphere's centre to the IMU, in sensor axes
  double lever_arm_sigma_m = 2e-3;
  std::optional<Eigen::Quaterniond> q_WI_start = {};  ///< attitude at the first sample; empty: tilt from gravity
  double gravity_m_s2 = 9.80665;
  /// readings at or above the range count as clipped, in addition to readings with clip flags
  double gyro_range_rad_s = 1e3;
  double accel_range_m_s2 = 1e5;
  /// Calibration from an earlier run, which replaces the prior of the sensor errors, the lever arm and the radius. The
  /// variances of the biases are increased by their prior variances, because biases change at every switch-on.
  std::shared_ptr<const RollingCalibration> calibration = {};

  using Expert = RollingExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.radius_m, {"radius_m", "m", 1e-12, 10.0, "radius of the sphere"});
    visit(p.radius_sigma_m, {"radius_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the radius; 0: exact",
                             ParameterAudience::common_use});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
    visit(p.lever_arm_sigma_m, {"lever_arm_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the lever arm",
                                ParameterAudience::common_use});
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 1e-12, 1e3,
                               "measuring range of the gyro; readings at or above this value count as saturated"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 1e-12, 1e5,
           "measuring range of the accelerometer; readings at or above this value count as saturated"});
    visit.group("", p.expert);
  }
};

/// Throws InvalidParams if a parameter is out of bounds.
void require_valid(const RollingParams& params);

}  // namespace tumble
