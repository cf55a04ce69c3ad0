// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// The structs in rest_params.hpp are parts of OdometryParams::Expert and describe the detection of rest.
namespace tumble {

/// RestBoundsParams limits rate and force at rest (`mapper_rest.hpp`). At rest, the rate differs from the bias and from
/// its mean by at most rate_rad_s. At rest, the specific force differs from gravity and from its mean by at most
/// force_m_s2. During the initial rest, the mean rate becomes the estimate of the gyro's bias.
struct RestBoundsParams {
  double levelling_max_s = 0.5;  ///< maximum duration of the initial rest that determines the tilt
  double rate_rad_s = 0.05;
  double force_m_s2 = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.levelling_max_s, {"rest_s", "s", 1e-9, 60.0,
                              "maximum part of the initial rest that is used to level the attitude", FieldRank::basic});
    visit(p.rate_rad_s,
          {"rest_rate_rad_s", "rad/s", 1e-6, 10.0,
           "at rest: maximum difference between the rate and the bias, and between the rate and its mean, per axis"});
    visit(p.force_m_s2, {"rest_force_m_s2", "m/s^2", 1e-6, 10.0,
                         "at rest: maximum difference between the specific force and gravity, and between the specific "
                         "force and its mean"});
  }
};

/// OdometryStartParams contains the accuracy of the state at the start, which limits the corrections by the first
/// sweeps.
struct OdometryStartParams {
  /// Standard deviation of the initial tilt for the registration: five times tilt_sigma_rad of WorldCovarianceParams,
  /// to allow for a start in motion.
  double level_sigma_rad = 0.01;
  double bias_rest_s = 0.1;  ///< minimum duration of a rest that determines the gyro's bias

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.level_sigma_rad,
          {"level_sigma_rad", "rad", 1e-9, 1.0, "standard deviation of corrections to the levelled tilt"});
    visit(p.bias_rest_s,
          {"bias_rest_s", "s", 0.0, 60.0, "minimum duration of an initial rest that calibrates the gyro bias"});
  }
};

/// StandstillParams contains the parameters of a stationary robot, at the start or while the IMU measures only gravity.
struct StandstillParams {
  double sigma_m_s = 0.05;  ///< standard deviation of the velocity while the IMU measures only gravity
  /// Maximum estimated speed of a robot that is treated as stationary while the IMU measures only gravity and no
  /// surface constrains the pose. The zero velocity prevents slow drift in a world without features.
  double creep_max_m_s = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s, {"sigma_m_s", "m/s", 1e-9, 100.0,
                        "standard deviation of the velocity at a later rest, when the IMU measures only gravity"});
    visit(p.creep_max_m_s,
          {"creep_max_m_s", "m/s", 0.0, 100.0,
           "if no surface constrains the pose, an IMU that measures only gravity is at rest below this speed"});
  }
};

}  // namespace tumble
