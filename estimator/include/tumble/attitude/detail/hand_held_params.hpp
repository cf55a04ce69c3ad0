// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct HandMotionModelParams {
  static constexpr double kHandTau_s = 0.1;        ///< correlation time of the hand's acceleration
  static constexpr double kVelocity_m_s = 1.0;     ///< standard deviation of the hand's velocity
  static constexpr double kVelocityTau_s = 0.3;    ///< correlation time of the hand's velocity
  static constexpr double kPosition_m = 1.0;       ///< standard deviation of the hand's position
  static constexpr double kPositionTau_s = 1.0;    ///< correlation time of the hand's position
  static constexpr double kPositionLeak_s = 10.0;  ///< time constant with which the hand's position returns to zero
  double hand_noise_adaptation = 0.8;  ///< weight of the measured power of the hand's acceleration: 0 (not used) to 1
  static constexpr double kHandWindow_s = 2.0;  ///< averaging time of the measured power of the hand's acceleration
  static constexpr double kHandNoiseFloorRatio =
      1.0;  ///< minimum ratio of the adapted to the assumed power spectral density of the hand's acceleration

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.hand_noise_adaptation,
          {"hand_noise_adaptation", "1", 0.0, 1.0,
           "share by which the assumed acceleration of the hand adapts to the measured acceleration; "
           "0: constant assumed acceleration",
           ParameterAudience::common_use});
  }
};

/// Errors of IMU readings other than white noise.
struct HandHeldSensorParams {
  static constexpr double kDeficitErrorRatio =
      0.02;  ///< error of an unclipped gyro element / saturation deficit of a clipped element
  static constexpr double kRailSigma_rad_s = 0.01;
  static constexpr double kAccelErrorRatio = 0.02;  ///< additional noise / (magnitude of the specific force - gravity)
  static constexpr double kRotationError_sqrts = 1e-3;  ///< angle random walk per rad/s of rate, from scale errors
  static constexpr double kRecoveredSigma_rad_s =
      1.0;  ///< clipped rates with a smaller standard deviation count as recovered
  static constexpr double kRecoveredTau_s = 0.005;
  static constexpr double kRecoveredScaleSigma =
      6e-3;  ///< standard deviation of the gyro's scale error in samples next to recovered rates
};

struct HandHeldExpertParams {
  double node_s = 0.01;  ///< time between two nodes
  int iterations_max = 15;
  double gap_max_s = 1.0;
  /// Factor on the assumed angular jerk for the reported covariances of HandHeldSmoother.
  double jerk_inflation = 4.0;
  RestDetector::Params rest_detector = {};
  HandMotionModelParams hand_motion = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.node_s,
          {"node_s", "s", 1e-3, 0.1, "time between two nodes of the smoother", ParameterAudience::common_use});
    visit(p.iterations_max,
          {"iterations_max", "1", 1, 1000, "maximum number of Gauss-Newton steps", ParameterAudience::common_use});
    visit(p.gap_max_s,
          {"gap_max_s", "s", 1e-300, 1e4, "maximum time between two samples; a longer gap causes an error"});
    visit(p.jerk_inflation, {"jerk_inflation", "1", 1.0, 100.0,
                             "factor on the assumed angular jerk in the computation of the reported covariances",
                             ParameterAudience::common_use});
    visit.group("rest_", p.rest_detector);
    visit.group("", p.hand_motion);
  }
};

struct HandHeldParams {
  double gravity_m_s2 = 9.80665;
  double gyro_noise_density = 5e-4;   ///< rad/s/sqrt(Hz)
  double accel_noise_density = 0.01;  ///< m/s^2/sqrt(Hz)
  double gyro_bias_sigma_rad_s = 0.02;
  double accel_bias_sigma_m_s2 = 0.02;
  double lever_arm_sigma_m = 0.03;
  double jerk_rad_s3_sqrts = 200.0;  ///< square root of the power spectral density of the angular jerk
  double hand_sigma_m_s2 = 5.0;      ///< standard deviation of the hand's acceleration

  using Expert = HandHeldExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
    visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-6, 1.0, "noise density of the gyro"});
    visit(p.accel_noise_density,
          {"accel_noise_m_s2_sqrt_hz", "m/s^2/sqrt(Hz)", 1e-5, 10.0,
           "noise density of the specific force, including unmodelled errors", ParameterAudience::common_use});
    visit(p.gyro_bias_sigma_rad_s, {"gyro_bias_sigma_rad_s", "rad/s", 1e-6, 10.0,
                                    "prior standard deviation of the gyro bias", ParameterAudience::common_use});
    visit(p.accel_bias_sigma_m_s2,
          {"accel_bias_sigma_m_s2", "m/s^2", 1e-6, 10.0, "prior standard deviation of the accelerometer bias",
           ParameterAudience::common_use});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 1e-6, 10.0, "prior standard deviation of the lever arm from the hand-held point",
           ParameterAudience::common_use});
    visit(p.jerk_rad_s3_sqrts, {"jerk_rad_s3_sqrts", "rad/s^3 sqrt(s)", 1e-2, 1e6,
                                "root power spectral density of the angular jerk", ParameterAudience::common_use});
    visit(p.hand_sigma_m_s2,
          {"hand_sigma_m_s2", "m/s^2", 1e-3, 1e3, "standard deviation of the hand-held point's acceleration",
           ParameterAudience::common_use});
    visit.group("", p.expert);
  }
};

}  // namespace tumble
