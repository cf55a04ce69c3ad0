// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/flight_arc.hpp"

/// Groups of LidarInertialOdometry::Params::Expert: what the mapper believes of the IMU in motion.
namespace tumble {

/// What the inertial side may be wrong by after kSpan_s, beside what RateState reports: standard deviations that grow
/// in proportion to time. Loose in doubt; tight holds a world with few features.
struct InertialNoiseParams {
  static constexpr double kSpan_s = 0.1;  ///< between two sweeps of most lidars
  double sigma_m = 0.003;
  double sigma_rad = 0.002;
  double sigma_m_s = 0.01;
  /// Of the angle turned, as a share of it: scale, misalignment, and a rate that changes within a sample.
  double rotation_share = 0.001;
  /// Of the specific force, as a share of its magnitude: velocity is uncertain by this times the integral of the force,
  /// which counts at impacts.
  double force_share = 0.03;
  /// Over a gap of the IMU velocity and rate are random walks, mapping.md (R99), (R100). Over 0.05 to 0.5 s of rigs
  /// that tumble the truth's are 2.4 to 4.1 and, of a rate that is known at both ends, 3 to 11.
  double gap_velocity_walk_m_s_sqrt_s = 3.0;
  double gap_rate_walk_rad_s_sqrt_s = 9.0;
  double rate_sigma_max_rad_s = 5.0;  ///< what RateState reports is believed up to this

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m, {"prior_sigma_m", "m", 1e-9, 1e3,
                      "standard deviation of the inertial prediction over 0.1 s: position", Rank::first});
    visit(p.sigma_rad, {"prior_sigma_rad", "rad", 1e-9, 1e3,
                        "standard deviation of the inertial prediction over 0.1 s: attitude", Rank::first});
    visit(p.sigma_m_s, {"prior_sigma_m_s", "m/s", 1e-9, 1e3,
                        "standard deviation of the inertial prediction over 0.1 s: velocity", Rank::first});
    visit(p.rotation_share, {"rotation_sigma_share", "1", 0.0, 1.0,
                             "standard deviation of the inertial prediction, as a share of the rotation", Rank::first});
    visit(p.force_share,
          {"force_sigma_share", "1", 0.0, 1.0,
           "standard deviation of the inertial prediction, as a share of the integrated force", Rank::first});
    visit(p.gap_velocity_walk_m_s_sqrt_s,
          {"gap_velocity_walk_m_s_sqrt_s", "m/s/sqrt(s)", 0.0, 1e3, "random walk of the velocity during an IMU gap"});
    visit(p.gap_rate_walk_rad_s_sqrt_s, {"gap_rate_walk_rad_s_sqrt_s", "rad/s/sqrt(s)", 0.0, 1e3,
                                         "random walk of the rate during an IMU gap, between the rates at both ends"});
    visit(p.rate_sigma_max_rad_s, {"rate_sigma_max_rad_s", "rad/s", 0.0, 100.0,
                                   "upper limit of the standard deviations reported in RateState"});
  }
};

/// An IMU at its rails. Readings of the accelerometer from accel_m_s2 on, or flagged by the device, are at its rail:
/// there the force may be larger by force_sigma_m_s2 (standard deviation), for as long as the rail lasts.
///
/// With estimate_deficit, the deficit of the rate on clipped axes is estimated in the registration, at
/// SweepTrajectory::kKnots knots a sweep; it acts on clipped samples only, there in proportion to the rate's reported
/// uncertainty. Its prior is that uncertainty, at least deficit_sigma_min_rad_s, correlated over deficit_time_s; on a
/// rail that lasts over the border of two sweeps it goes on from where it was.
struct RailedImuParams {
  double accel_m_s2 = 1e5;
  double force_sigma_m_s2 = 50.0;
  double rate_sigma_rad_s = 3.0;  ///< assumed for a rate on a clipped axis that the rate method did not recover
  bool estimate_deficit = false;
  double deficit_sigma_min_rad_s = 1.0;
  double deficit_time_s = 0.3;
  double deficit_carry_max = 3.0;    ///< over a border it grows by no more where less is known after it
  double deficit_knot_share = 0.05;  ///< of its standard deviation, by which a knot may differ from its neighbours

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_m_s2,
          {"accel_rail_m_s2", "m/s^2", 1e-9, 1e5, "accelerometer readings from this value on are at the rail"});
    visit(p.force_sigma_m_s2,
          {"railed_force_m_s2", "m/s^2", 0.0, 1e4, "standard deviation of the force at the accelerometer rail"});
    visit(p.rate_sigma_rad_s,
          {"clipped_sigma_rad_s", "rad/s", 0.0, 100.0,
           "assumed standard deviation of a clipped axis that the rate method did not recover", Rank::first});
    visit(p.estimate_deficit, on_off("estimate_saturation_deficit",
                                     "1: estimate the saturation deficit of clipped axes in the registration"));
    visit(p.deficit_sigma_min_rad_s,
          {"deficit_sigma_min_rad_s", "rad/s", 1e-9, 100.0,
           "least prior standard deviation of the saturation deficit of a clipped axis", Rank::first});
    visit(p.deficit_time_s,
          {"deficit_time_s", "s", 1e-3, 1e3, "correlation time of the saturation deficit", Rank::first});
    visit(p.deficit_carry_max, {"deficit_carry_max", "1", 0.0, 1e3,
                                "largest growth factor of the saturation deficit from one sweep to the next"});
    visit(p.deficit_knot_share, {"deficit_knot_share", "1", 1e-6, 1.0,
                                 "standard deviation between neighbouring knots of the deficit, as a share of the "
                                 "deficit's standard deviation"});
  }
};

/// A body whose flight is told by the ballistic arc: where the specific force at the centre of mass is below
/// force_m_s2, the accelerometer's reading gives way to what flight makes it, and a gap of the IMU that begins in
/// flight is bridged by the arc.
struct FlightParams {
  std::optional<FlyingBody> body;  ///< empty: the accelerometer throughout
  double force_m_s2 = 4.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.force_m_s2, {"flight_force_m_s2", "m/s^2", 0.0, 100.0,
                         "with flight_arc: force at the centre of mass below which the body is in flight"});
  }
};

}  // namespace tumble
