// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

/// At rest, the rate differs from the bias and from its mean by at most kRate_rad_s. The specific force at rest differs
/// from gravity and from its mean by at most kForce_m_s2.
struct StationaryBoundsParams {
  double levelling_max_s = 0.5;  ///< maximum duration of the initial rest that determines the tilt
  static constexpr double kRate_rad_s = 0.05;
  static constexpr double kForce_m_s2 = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.levelling_max_s,
          {"rest_s", "s", 1e-9, 60.0, "maximum duration of the initial rest that determines the tilt",
           ParameterRank::common_use});
  }
};

struct OdometryStartParams {
  /// standard deviation of the initial tilt in the registration; larger than in WorldCovarianceParams, for starts in
  /// motion
  static constexpr double kLevelSigma_rad = 0.01;
  double bias_rest_s = 0.1;  ///< minimum duration of a rest that determines the gyro's bias

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.bias_rest_s,
          {"bias_rest_s", "s", 0.0, 60.0, "minimum duration of an initial rest that calibrates the gyro bias"});
  }
};

struct Standstill {
  static constexpr double kSigma_m_s =
      0.05;  ///< standard deviation of the velocity while the IMU measures only gravity
  /// Maximum estimated speed of a robot that is treated as stationary while the IMU measures only gravity and no
  /// surface constrains the pose. The zero velocity prevents slow drift in a world without features.
  static constexpr double kCreepMax_m_s = 0.5;
};

}  // namespace tumble
