// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// How the sphere meets the floor.
enum class RollingMode : std::uint8_t {
  grip,     ///< the contact point stands still, the floor is level
  slip,     ///< it moves along the floor: spinning too fast or sliding
  bump,     ///< it also rises or falls: an obstacle, or the air
  incline,  ///< it stands still on a slope, which is estimated
  rough,    ///< it stands still, the floor goes up and down about the level
};
inline constexpr int kRollingModes = 5;

/// Whether the contact point may move in this mode.
inline bool slips(RollingMode mode) {
  return mode == RollingMode::slip || mode == RollingMode::bump;
}

/// What the sphere, its IMU and the floor are like; shared by the live filter and the smoother.
struct RollingParams {
  double radius_m = 0.0;  ///< has no default
  double gravity_m_s2 = 9.80665;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes; length up to 10
  std::optional<Eigen::Quaterniond> q_WI_start = {};      ///< attitude at the first sample; levelled when not given
  double node_s = 0.02;                                   ///< time between two measurements
  /// Readings are averaged to this length, at which all thresholds here are meant; zero: taken as they come. A slower
  /// IMU's are longer as they are.
  double reading_s = 4e-3;
  // Prior sigmas. Zero: known.
  double tilt_sigma_rad = 6e-3;
  double velocity_sigma_m_s = 2e-3;
  double gyro_bias_sigma_rad_s = 8.7e-4;  ///< 0.05 deg/s
  double accel_bias_sigma_m_s2 = 0.04;
  double accel_scale_sigma = 3.5e-3;  ///< each entry of scale and misalignment
  double gyro_scale_sigma = 2.5e-3;
  double accel_delay_sigma_s = 3e-3;  ///< accelerometer later than gyro
  double lever_arm_sigma_m = 2e-3;
  double radius_sigma_m = 0.0;
  double slope_sigma = 0.15;  ///< of the sines of a slope, when one begins
  // Noise.
  double attitude_walk_rad_sqrts = 1e-4;  ///< 0.006 deg/sqrt(s)
  double rate_error_sqrts = 6e-4;         ///< per rad/s turned
  double velocity_walk_m_s_sqrts = 6e-3;
  double spin_force_sqrts = 4e-5;  ///< velocity walk more, per (rad/s)^2 turned: what errors make of large forces
  double gyro_bias_walk_rad_s_sqrts = 1.7e-5;
  double accel_bias_walk_m_s2_sqrts = 2e-3;
  double grip_sigma_m_s = 3e-3;      ///< of the contact velocity while gripping
  double grip_sigma_share = 1.5e-3;  ///< more, as a share of the rolling speed
  double vertical_sigma_m_s = 8e-3;
  double rough_share = 0.055;               ///< more on a rough floor, as a share of the rolling speed
  double rough_radius_walk_m_sqrts = 1e-4;  ///< of the radius that it rolls with there
  double slope_walk_sqrts = 0.02;
  double impact_share = 0.06;  ///< of the velocity that a shock gives: error of its timing and direction
  double rest_velocity_sigma_m_s = 2e-3;
  double rest_rate_sigma_rad_s = 3e-3;  ///< of a node's mean rate at rest
  // Clipped readings, by the device's flags or from this size on, say no more than that; how short they may be.
  double gyro_range_rad_s = 1e3;
  double accel_range_m_s2 = 1e5;
  double clipped_rate_sigma_rad_s = 5.0;
  /// Above zero: a rate beyond the range that no flag calls clipped was recovered (ImuMerge) to this.
  double recovered_rate_sigma_rad_s = 0.0;
  double clipped_force_sigma_m_s2 = 4.0;
  /// A blow within one sample may have met the accelerometer's rail though its mean did not: sigma of what is missing
  /// along the force, as a share of it; full from 0.6 of the range on, none up to 0.3.
  double subsample_saturation_share = 0.25;
  // What the sphere is able to: no grip is believed that would make it roll faster; where the velocity is lost it is
  // about zero, with this sigma of its mean over a second.
  double speed_max_m_s = 2.5;
  double speed_sigma_m_s = 1.0;
  /// A wheel that stays on the floor meets no blows: mean of what one may give in a node.
  double unexplained_impact_m_s = 0.03;
  // Change of mode, per second.
  double slip_begins_per_s = 0.5, slip_ends_per_s = 2.0;
  double bump_begins_per_s = 0.3, bump_ends_per_s = 5.0;
  double slip_bump_per_s = 0.2;                                   ///< slip to bump and back
  double incline_begins_per_s = 0.001, incline_ends_per_s = 0.1;  ///< from and to the level
  double rough_begins_per_s = 0.02, rough_ends_per_s = 0.1;
  double event_shortest_s = 0.06;  ///< least stay in slip or bump
  /// Rest; its readings are the means of nodes. 0.02 rad/s in all, shared by the axes, is 3 mm/s of the sphere. The
  /// bounds are measured: as loose as 0.02 an axis, a sphere that is about to stand drifts by half as much again.
  /// What is left between them and bounds on the norm is up to 40 um of drift, of either sign.
  RestDetector::Params rest = {
      .rate_max_rad_s = 0.0115, .rate_spread_rad_s = 0.016, .force_spread_m_s2 = 0.15, .rest_s = 0.4, .memory_s = 0.1};
  // Gaps. Between two readings further apart than gap_from_s nothing is known of the force; the rate is taken to have
  // gone straight from the one to the other, give or take what an angular acceleration of gap_acceleration_rad_s2 does.
  double gap_from_s = 0.06;
  double gap_max_s = 1.0;  ///< a longer one ends the run
  double gap_acceleration_rad_s2 = 15.0;
  /// A first reading that turns faster than this was taken in motion: attitude and velocity are then known by that much
  /// less.
  double start_rate_rad_s = 0.1;
  /// By how much more than this the horizontal sigma grows in an event that is called uncertain.
  double uncertain_m = 0.03;

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.radius_m, {"radius_m", "m", 1e-12, 10.0, "of the sphere"});
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "from the centre to the IMU, sensor axes"});
    visit(p.node_s, {"node_s", "s", 1e-3, 0.1, "time between two measurements"});
    visit(p.reading_s, {"reading_s", "s", 0.0, 0.1, "readings are averaged to this length; 0: taken as they come"});
    visit(p.tilt_sigma_rad,
          {"tilt_sigma_rad", "rad", 0.0, 1e3, "prior of the levelling by the first sample", Rank::first});
    visit(p.velocity_sigma_m_s, {"velocity_sigma_m_s", "m/s", 0.0, 1e3, "prior of the velocity at the start"});
    visit(p.gyro_bias_sigma_rad_s,
          {"gyro_bias_sigma_rad_s", "rad/s", 0.0, 1e3, "prior of the gyro's bias", Rank::first});
    visit(p.accel_bias_sigma_m_s2,
          {"accel_bias_sigma_m_s2", "m/s^2", 0.0, 1e3, "prior of the accelerometer's bias", Rank::first});
    visit(p.accel_scale_sigma,
          {"accel_scale_sigma", "1", 0.0, 1e3, "prior of each entry of the accelerometer's scale and misalignment"});
    visit(p.gyro_scale_sigma,
          {"gyro_scale_sigma", "1", 0.0, 1e3, "prior of each entry of the gyro's scale and misalignment"});
    visit(p.accel_delay_sigma_s,
          {"accel_delay_sigma_s", "s", 0.0, 1e3, "prior of how much later the accelerometer is than the gyro"});
    visit(p.lever_arm_sigma_m, {"lever_arm_sigma_m", "m", 0.0, 1e3, "prior of the lever arm", Rank::first});
    visit(p.radius_sigma_m, {"radius_sigma_m", "m", 0.0, 1e3, "prior of the radius; 0: it is known", Rank::first});
    visit(p.slope_sigma, {"slope_sigma", "1", 0.0, 1e3, "of the sines of a slope, when one begins"});
    visit(p.attitude_walk_rad_sqrts, {"attitude_walk_rad_sqrts", "rad/sqrt(s)", 1e-12, 1e3, "angle random walk"});
    visit(p.rate_error_sqrts, {"rate_error_sqrts", "sqrt(s)", 1e-12, 1e3, "angle random walk per rad/s turned"});
    visit(p.velocity_walk_m_s_sqrts, {"velocity_walk_m_s_sqrts", "m/s/sqrt(s)", 1e-12, 1e3, "velocity random walk"});
    visit(p.spin_force_sqrts, {"spin_force_sqrts", "m/s/sqrt(s)/(rad/s)^2", 0.0, 1e3,
                               "velocity walk more, per (rad/s)^2 turned: what errors make of large forces"});
    visit(p.gyro_bias_walk_rad_s_sqrts,
          {"gyro_bias_walk_rad_s_sqrts", "rad/s/sqrt(s)", 1e-12, 1e3, "random walk of the gyro's bias"});
    visit(p.accel_bias_walk_m_s2_sqrts,
          {"accel_bias_walk_m_s2_sqrts", "m/s^2/sqrt(s)", 1e-12, 1e3, "random walk of the accelerometer's bias"});
    visit(p.grip_sigma_m_s,
          {"grip_sigma_m_s", "m/s", 1e-12, 1e3, "of the contact velocity while gripping", Rank::first});
    visit(p.grip_sigma_share, {"grip_sigma_share", "1", 1e-12, 1e3, "and further, as a share of the rolling speed"});
    visit(p.vertical_sigma_m_s, {"vertical_sigma_m_s", "m/s", 1e-12, 1e3, "of the vertical velocity while rolling"});
    visit(p.rough_share, {"rough_share", "1", 1e-12, 1e3,
                          "of the rolling speed: how fast a rough floor goes up and down", Rank::first});
    visit(p.rough_radius_walk_m_sqrts,
          {"rough_radius_walk_m_sqrts", "m/sqrt(s)", 0.0, 1.0, "of the radius that it rolls with there"});
    visit(p.slope_walk_sqrts, {"slope_walk_sqrts", "sqrt(s)", 1e-12, 1e3, "random walk of the sines of a slope"});
    visit(p.impact_share,
          {"impact_share", "1", 0.0, 1e3, "of the velocity that a shock gives: error of its timing and direction"});
    visit(p.rest_velocity_sigma_m_s,
          {"rest_velocity_sigma_m_s", "m/s", 1e-12, 1e3, "of a node's mean velocity at rest"});
    visit(p.rest_rate_sigma_rad_s, {"rest_rate_sigma_rad_s", "rad/s", 1e-12, 1e3, "of a node's mean rate at rest"});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 1e-12, 1e3, "rates from here on are at the rail"});
    visit(p.accel_range_m_s2, {"accel_range_m_s2", "m/s^2", 1e-12, 1e5, "forces from here on are at the rail"});
    visit(p.clipped_rate_sigma_rad_s,
          {"clipped_rate_sigma_rad_s", "rad/s", 1e-12, 1e3, "how short a clipped rate may be"});
    visit(p.recovered_rate_sigma_rad_s,
          {"recovered_rate_sigma_rad_s", "rad/s", 0.0, 1e3,
           "of a rate beyond the range that was recovered from several IMUs; 0: none is"});
    visit(p.clipped_force_sigma_m_s2,
          {"clipped_force_sigma_m_s2", "m/s^2", 1e-12, 1e3, "how short a clipped force may be"});
    visit(p.subsample_saturation_share, {"subsample_saturation_share", "1", 0.0, 10.0,
                                         "of a blow within one sample: what its mean may lack, as a share of it"});
    visit(p.speed_max_m_s, {"speed_max_m_s", "m/s", 1e-12, 1e3, "no grip is believed that would make it roll faster"});
    visit(p.speed_sigma_m_s,
          {"speed_sigma_m_s", "m/s", 1e-12, 1e3, "where the velocity is lost: of its mean over a second, about zero"});
    visit(p.unexplained_impact_m_s, {"unexplained_impact_m_s", "m/s", 1e-12, 1e3,
                                     "mean of what a blow may give in a node while the wheel stays on the floor"});
    visit(p.slip_begins_per_s, {"slip_begins_per_s", "1/s", 1e-12, 1e3, "rate of grip changing to slip", Rank::first});
    visit(p.slip_ends_per_s, {"slip_ends_per_s", "1/s", 1e-12, 1e3, "rate of slip changing to grip", Rank::first});
    visit(p.bump_begins_per_s, {"bump_begins_per_s", "1/s", 1e-12, 1e3, "rate of grip changing to bump", Rank::first});
    visit(p.bump_ends_per_s, {"bump_ends_per_s", "1/s", 1e-12, 1e3, "rate of bump changing to grip", Rank::first});
    visit(p.slip_bump_per_s, {"slip_bump_per_s", "1/s", 1e-12, 1e3, "rate of slip changing to bump and back"});
    visit(p.incline_begins_per_s,
          {"incline_begins_per_s", "1/s", 1e-12, 1e3, "rate of a slope beginning", Rank::first});
    visit(p.incline_ends_per_s, {"incline_ends_per_s", "1/s", 1e-12, 1e3, "rate of a slope ending"});
    visit(p.rough_begins_per_s, {"rough_begins_per_s", "1/s", 1e-12, 1e3, "rate of a rough floor beginning"});
    visit(p.rough_ends_per_s, {"rough_ends_per_s", "1/s", 1e-12, 1e3, "rate of a rough floor ending"});
    visit(p.event_shortest_s, {"event_shortest_s", "s", 0.0, 10.0, "least stay in slip or bump", Rank::first});
    visit.group("rest_", p.rest);
    visit(p.gap_from_s, {"gap_from_s", "s", 1e-9, 1.0, "between readings further apart nothing is known of the force"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-9, 1.0, "longest time between two samples before the run is refused"});
    visit(p.gap_acceleration_rad_s2,
          {"gap_acceleration_rad_s2", "rad/s^2", 1e-12, 1e4, "what the rate does in a gap beside going straight"});
    visit(p.start_rate_rad_s,
          {"start_rate_rad_s", "rad/s", 1e-12, 10.0, "a first reading that turns faster was taken in motion"});
    visit(p.uncertain_m, {"uncertain_m", "m", 1e-12, 1e3,
                          "an event in which the horizontal sigma grows by much more than this is called uncertain"});
  }
};

/// Throws InvalidParams when a parameter is outside of its bound.
void require_valid(const RollingParams& params);

/// The trajectory and the constants about which errors are held.
struct RollingNominal {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d accel_scale = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gyro_scale = Eigen::Matrix3d::Zero();
  double accel_delay_s = 0.0;
  Eigen::Vector3d lever_arm_error_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< horizontal part of the floor's unit normal, W
  double radius_error_m = 0.0;
  Eigen::Vector3d last_rate_I_rad_s = Eigen::Vector3d::Zero();  ///< as it was read last
  bool operator==(const RollingNominal&) const = default;
};

/// Integrals since the last node: of R, R f, R (x) f^T, R (x) w^T, R (w x f), w, f, |w|^2.
struct RollingSums {
  Eigen::Matrix3d R_s = Eigen::Matrix3d::Zero();
  Eigen::Vector3d f_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 9> R_f = Eigen::Matrix<double, 3, 9>::Zero(), R_w = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d R_wxf = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_I_rad = Eigen::Vector3d::Zero(), f_I_m_s = Eigen::Vector3d::Zero();
  double turned_rad2_s = 0.0;
  double rate_clipped_s = 0.0, force_clipped_s = 0.0;  ///< with a reading that says nothing
  double recovered_s = 0.0;                            ///< with a rate that was recovered
  double impact_m_s = 0.0;                             ///< of | |f| - g | beyond the usual
  double unexplained_impact_m_s = 0.0;                 ///< the same without what the turning may explain
  Eigen::Vector3d subsample_saturation_W_m_s =
      Eigen::Vector3d::Zero();  ///< sigma of what a rail took unseen, along the force
  // of a gap: its length, variance of the turning, and of the rate times time
  double gap_s = 0.0, gap_rad2 = 0.0, gap_rate_rad2_s = 0.0;
  double node_s = 0.0;
  bool operator==(const RollingSums&) const = default;
};

}  // namespace tumble
