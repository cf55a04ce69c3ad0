// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Standard deviations of the errors of inertial integration over kSpan_s, in addition to the uncertainty in
/// AngularRateState. Smaller standard deviations constrain the pose more strongly in a world with few features.
struct InertialNoiseParams {
  static constexpr double kSweepInterval_s = 0.1;  ///< time between two sweeps of most lidars
  double sigma_m = 0.003;
  double sigma_rad = 0.002;
  static constexpr double kSigma_m_s = 0.01;
  /// rotation error relative to the rotation angle
  static constexpr double kRotationNoiseRatio = 0.001;
  /// velocity error relative to the integral of the specific force
  static constexpr double kForceShare = 0.03;
  /// Random walks of velocity and rate over a gap of the IMU: mapping.md (R43), (R44). For tumbling rigs and gaps of
  /// 0.05 to 0.5 s, the true random walks are 2.4 to 4.1 m/s and 3 to 11 rad/s per sqrt(s).
  double gap_velocity_walk_m_s_sqrt_s = 3.0;
  double gap_rate_walk_rad_s_sqrt_s = 9.0;
  static constexpr double kRateSigmaMax_rad_s = 5.0;  ///< upper bound of the standard deviation in AngularRateState

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m,
          {"prior_sigma_m", "m", 1e-9, 1e3, "standard deviation of the position after 0.1 s of inertial prediction",
           ParameterRank::common_use});
    visit(p.sigma_rad,
          {"prior_sigma_rad", "rad", 1e-9, 1e3, "standard deviation of the attitude after 0.1 s of inertial prediction",
           ParameterRank::common_use});
    visit(p.gap_velocity_walk_m_s_sqrt_s,
          {"gap_velocity_walk_m_s_sqrt_s", "m/s/sqrt(s)", 0.0, 1e3, "random walk of the velocity during an IMU gap"});
    visit(p.gap_rate_walk_rad_s_sqrt_s,
          {"gap_rate_walk_rad_s_sqrt_s", "rad/s/sqrt(s)", 0.0, 1e3,
           "random walk of the rate during an IMU gap, about a linear interpolation between the rates at both ends"});
  }
};

/// SaturatedImuParams contains the parameters of a saturated IMU. Accelerometer readings are saturated if they are at
/// or above `accel_m_s2` or if the device flags them.
///
/// If `estimate_deficit` is true, the registration estimates the saturation deficit of the rate on clipped axes, at
/// SweepTrajectory::kKnots knots per sweep. The saturation deficit changes only clipped samples, in proportion to the
/// reported uncertainty of the rate. The prior standard deviation of the saturation deficit is the reported
/// uncertainty, but at least 1 rad/s, correlated over 0.3 s. If saturation lasts across the boundary of two sweeps, the
/// saturation deficit is continuous at the boundary.
struct SaturatedImuParams {
  double accel_m_s2 = 1e5;
  static constexpr double kRateSigma_rad_s = 3.0;  ///< standard deviation of a clipped rate that was not recovered
  bool estimate_deficit = false;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_m_s2,
          {"accel_rail_m_s2", "m/s^2", 1e-9, 1e5, "accelerometer readings from this value on count as saturated"});
    visit(p.estimate_deficit, boolean_field("estimate_saturation_deficit",
                                            "1: estimate the saturation deficit of clipped axes in the registration"));
  }
};

}  // namespace tumble
