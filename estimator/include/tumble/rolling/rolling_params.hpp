// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/rolling/detail/rolling_floor_params.hpp"
#include "tumble/rolling/detail/rolling_imu_params.hpp"

namespace tumble {

/// What few need of RollingParams, by meaning. Fields bear the names that they have in tables and on command lines.
struct RollingExpertParams {
  double node_s = 0.02;  ///< time between two measurements
  /// Readings are averaged to this length, at which all thresholds here are meant; zero: taken as they come. A slower
  /// IMU's are longer as they are.
  double reading_s = 4e-3;
  /// Rest; its readings are the means of nodes. 0.02 rad/s in all, shared by the axes, is 3 mm/s of the sphere. The
  /// bounds are measured: as loose as 0.02 an axis, a sphere that is about to stand drifts by half as much again.
  /// What is left between them and bounds on the norm is up to 40 um of drift, of either sign.
  RestDetector::Params rest = {
      .rate_max_rad_s = 0.0115, .rate_spread_rad_s = 0.016, .force_spread_m_s2 = 0.15, .rest_s = 0.4, .memory_s = 0.1};
  RollingPriorParams prior = {};
  RollingImuNoiseParams noise = {};
  RollingContactParams contact = {};
  RollingRailParams rails = {};
  RollingModeParams modes = {};
  RollingGapParams gap = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.node_s, {"node_s", "s", 1e-3, 0.1, "time between two measurement updates"});
    visit(p.reading_s, {"reading_s", "s", 0.0, 0.1, "duration over which readings are averaged; 0: no averaging"});
    visit.group("rest_", p.rest);
    visit.group("", p.prior);
    visit.group("", p.noise);
    visit.group("", p.contact);
    visit.group("", p.rails);
    visit.group("", p.modes);
    visit.group("", p.gap);
  }
};

/// What the sphere, its IMU and the floor are like; shared by the live filter and the smoother.
struct RollingParams {
  double radius_m = 0.0;                                  ///< has no default
  double radius_sigma_m = 0.0;                            ///< 0: it is known
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes; length up to 10
  double lever_arm_sigma_m = 2e-3;
  std::optional<Eigen::Quaterniond> q_WI_start = {};  ///< attitude at the first sample; levelled when not given
  double gravity_m_s2 = 9.80665;
  /// Readings from here on are clipped, as those are that the device flags: they say no more than that.
  double gyro_range_rad_s = 1e3;
  double accel_range_m_s2 = 1e5;
  double speed_max_m_s = 2.5;  ///< what the sphere is able to: no grip is believed that would make it roll faster

  using Expert = RollingExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.radius_m, {"radius_m", "m", 1e-12, 10.0, "radius of the sphere"});
    visit(p.radius_sigma_m,
          {"radius_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the radius; 0: exact", Rank::first});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the lever arm", Rank::first});
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 1e-12, 1e3, "rates from this value on are at the rail"});
    visit(p.accel_range_m_s2, {"accel_range_m_s2", "m/s^2", 1e-12, 1e5, "forces from this value on are at the rail"});
    visit(p.speed_max_m_s, {"speed_max_m_s", "m/s", 1e-12, 1e3, "largest rolling speed; grip is rejected above it"});
    visit.group("", p.expert);
  }
};

/// Throws InvalidParams when a parameter is outside of its bound.
void require_valid(const RollingParams& params);

}  // namespace tumble
