// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

/// At rest, the rate differs from the bias and from its mean by at most rate_rad_s. The specific force at rest differs
/// from gravity and from its mean by at most force_m_s2.
struct RestBoundsParams {
  double levelling_max_s = 0.5;  ///< maximum duration of the initial rest that determines the tilt
  double rate_rad_s = 0.05;
  double force_m_s2 = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.levelling_max_s, {"rest_s", "s", 1e-9, 60.0,
                              "maximum duration of the initial rest that determines the tilt", FieldRank::basic});
    visit(p.rate_rad_s,
          {"rest_rate_rad_s", "rad/s", 1e-6, 10.0,
           "at rest: maximum difference between the rate and the bias, and between the rate and its mean, per axis"});
    visit(p.force_m_s2, {"rest_force_m_s2", "m/s^2", 1e-6, 10.0,
                         "at rest: maximum difference between the specific force and gravity, and between the specific "
                         "force and its mean"});
  }
};

struct OdometryStartParams {
  /// standard deviation of the initial tilt in the registration; larger than in WorldCovarianceParams, for starts in
  /// motion
  double level_sigma_rad = 0.01;
  double speed_sigma_m_s = 0.05;  ///< standard deviation of the speed of a robot that seems to be at rest
  double bias_rest_s = 0.1;       ///< minimum duration of a rest that determines the gyro's bias

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.level_sigma_rad, {"level_sigma_rad", "rad", 1e-9, 1.0, "standard deviation of the initial tilt"});
    visit(p.speed_sigma_m_s, {"speed_sigma_m_s", "m/s", 1e-9, 100.0,
                              "standard deviation of the initial speed of a robot that seems to be at rest"});
    visit(p.bias_rest_s,
          {"bias_rest_s", "s", 0.0, 60.0, "minimum duration of an initial rest that calibrates the gyro bias"});
  }
};

struct StandstillParams {
  double start_sigma_m_s = 0.01;  ///< standard deviation of the velocity during the initial rest
  double sigma_m_s = 0.05;        ///< standard deviation of the velocity while the IMU measures only gravity
  /// Maximum estimated speed at which a robot still counts as stationary, which prevents slow drift in a world without
  /// features. Applies while the IMU measures only gravity and no surface constrains the pose.
  double creep_max_m_s = 0.5;
  int sweeps_min = 3;         ///< minimum number of consecutive sweeps at rest before creep_max_m_s applies
  double noise_share = 0.02;  ///< ratio of the inertial prediction's noise at rest to its noise in motion

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.start_sigma_m_s,
          {"start_sigma_m_s", "m/s", 1e-9, 100.0, "standard deviation of the velocity during the initial rest"});
    visit(p.sigma_m_s, {"sigma_m_s", "m/s", 1e-9, 100.0,
                        "standard deviation of the velocity at a later rest, when the IMU measures only gravity"});
    visit(
        p.creep_max_m_s,
        {"creep_max_m_s", "m/s", 0.0, 100.0,
         "maximum estimated speed of a robot at rest, if no surface constrains the pose and the IMU measures gravity"});
    visit(p.sweeps_min,
          {"sweeps_min", "1", 1, 1e6, "minimum number of consecutive sweeps at rest before creep_max_m_s applies"});
    visit(p.noise_share,
          {"noise_share", "1", 1e-9, 1.0,
           "standard deviations of the inertial prediction at rest, as a share of the standard deviations in motion"});
  }
};

}  // namespace tumble
