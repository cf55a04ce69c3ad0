// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/flight_arc.hpp"

/// The structs in inertial_params.hpp are parts of OdometryParams::Expert and describe the IMU in motion.
namespace tumble {

/// InertialNoiseParams contains the standard deviations of the errors of inertial integration over kSpan_s. The errors
/// come in addition to the uncertainty in RateState, and grow in proportion to time. Choose larger standard deviations
/// if unsure. Smaller standard deviations constrain the pose more strongly in a world with few features.
struct InertialNoiseParams {
  static constexpr double kSpan_s = 0.1;  ///< time between two sweeps of most lidars
  double sigma_m = 0.003;
  double sigma_rad = 0.002;
  double sigma_m_s = 0.01;
  /// Rotation error relative to the rotation angle, due to scale, misalignment, and rate changes within a sample.
  double rotation_noise_ratio = 0.001;
  /// Velocity error relative to the integral of the specific force. The velocity error is important at impacts.
  double force_share = 0.03;
  /// Random walks of velocity and rate over a gap of the IMU, see mapping.md (R43), (R44). For tumbling rigs and gaps
  /// of 0.05 to 0.5 s, the true velocity walks are 2.4 to 4.1 m/s per sqrt(s). If the rate is known at both ends of the
  /// gap, the true rate walks are 3 to 11 rad/s per sqrt(s).
  double gap_velocity_walk_m_s_sqrt_s = 3.0;
  double gap_rate_walk_rad_s_sqrt_s = 9.0;
  double rate_sigma_max_rad_s = 5.0;  ///< upper bound of the standard deviation in RateState

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m, {"prior_sigma_m", "m", 1e-9, 1e3,
                      "standard deviation of the position after 0.1 s of inertial prediction", FieldRank::basic});
    visit(p.sigma_rad, {"prior_sigma_rad", "rad", 1e-9, 1e3,
                        "standard deviation of the attitude after 0.1 s of inertial prediction", FieldRank::basic});
    visit(p.sigma_m_s, {"prior_sigma_m_s", "m/s", 1e-9, 1e3,
                        "standard deviation of the velocity after 0.1 s of inertial prediction", FieldRank::basic});
    visit(
        p.rotation_noise_ratio,
        {"rotation_sigma_ratio", "1", 0.0, 1.0,
         "standard deviation of the attitude after inertial prediction, as a share of the rotation", FieldRank::basic});
    visit(p.force_share,
          {"force_sigma_ratio", "1", 0.0, 1.0,
           "standard deviation of the velocity after inertial prediction, as a share of the integrated force",
           FieldRank::basic});
    visit(p.gap_velocity_walk_m_s_sqrt_s,
          {"gap_velocity_walk_m_s_sqrt_s", "m/s/sqrt(s)", 0.0, 1e3, "random walk of the velocity during an IMU gap"});
    visit(p.gap_rate_walk_rad_s_sqrt_s,
          {"gap_rate_walk_rad_s_sqrt_s", "rad/s/sqrt(s)", 0.0, 1e3,
           "random walk of the rate during an IMU gap, about the line between the rates at both ends"});
    visit(p.rate_sigma_max_rad_s, {"rate_sigma_max_rad_s", "rad/s", 0.0, 100.0,
                                   "upper limit of the standard deviations reported in RateState"});
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
  double rate_sigma_rad_s = 3.0;  ///< standard deviation of a clipped rate that was not recovered
  bool estimate_deficit = false;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_m_s2,
          {"accel_rail_m_s2", "m/s^2", 1e-9, 1e5, "accelerometer readings from this value on count as saturated"});
    visit(p.rate_sigma_rad_s,
          {"clipped_sigma_rad_s", "rad/s", 0.0, 100.0,
           "assumed standard deviation of a clipped axis that the rate method did not recover", FieldRank::basic});
    visit(p.estimate_deficit, switch_field("estimate_saturation_deficit",
                                           "1: estimate the saturation deficit of clipped axes in the registration"));
  }
};

/// FlightParams contains the parameters of the ballistic arc of a body in flight. Where the specific force at the
/// centre of mass is below force_m_s2, the force of free flight replaces the accelerometer's reading. The ballistic arc
/// also bridges a gap of the IMU that begins in flight.
struct FlightParams {
  std::optional<FlyingBody> body;  ///< empty: always use the accelerometer
  double force_m_s2 = 4.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.force_m_s2,
          {"flight_force_m_s2", "m/s^2", 0.0, 100.0,
           "with flight_arc: the body is in flight if the force at the centre of mass is below this value"});
  }
};

}  // namespace tumble
