// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "tumble/common/imu.hpp"

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
  double radius_m = 0.145;                                ///< bound (0, 10]
  double gravity_m_s2 = 9.80665;                          ///< bound (0, 100]
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes; length up to 10
  std::optional<Eigen::Quaterniond> q_WI_start = {};      ///< attitude at the first sample; levelled when not given
  double node_s = 0.02;                                   ///< time between two measurements; bound [1e-3, 0.1]
  /// Readings are averaged to this length, at which all thresholds here are meant; zero: taken as they come. A slower
  /// IMU's are longer as they are. Bound [0, 0.1].
  double reading_s = 4e-3;
  // Prior sigmas; bounds [0, 1e3]. Zero: known.
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
  // Noise; bounds (0, 1e3].
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
  double rough_radius_walk_m_sqrts = 1e-4;  ///< of the radius that it rolls with there; bound [0, 1]
  double slope_walk_sqrts = 0.02;
  double impact_share = 0.06;  ///< of the velocity that a shock gives: error of its timing and direction
  double rest_velocity_sigma_m_s = 2e-3;
  double rest_rate_sigma_rad_s = 3e-3;  ///< of a node's mean rate at rest
  // Clipped readings, by the device's flags or from this size on, say no more than that; how short they may be.
  double gyro_range_rad_s = 1e3;          ///< bound (0, 1e3]
  double accel_range_m_s2 = 1e5;          ///< bound (0, 1e5]
  double clipped_rate_sigma_rad_s = 5.0;  ///< bound (0, 1e3]
  /// Above zero: a rate beyond the range that no flag calls clipped was recovered (ImuMerge) to this; bound [0, 1e3].
  double recovered_rate_sigma_rad_s = 0.0;
  double clipped_force_sigma_m_s2 = 4.0;  ///< bound (0, 1e3]
  /// A blow within one sample may have met the accelerometer's rail though its mean did not: sigma of what is missing
  /// along the force, as a share of it; full from 0.6 of the range on, none up to 0.3; bound [0, 10].
  double subsample_saturation_share = 0.25;
  // What the sphere is able to: no grip is believed that would make it roll faster; where the velocity is lost it is
  // about zero, with this sigma of its mean over a second.
  double speed_max_m_s = 2.5;    ///< bound (0, 1e3]
  double speed_sigma_m_s = 1.0;  ///< bound (0, 1e3]
  /// A wheel that stays on the floor meets no blows: mean of what one may give in a node; bound (0, 1e3].
  double unexplained_impact_m_s = 0.03;
  // Change of mode, per second; bounds (0, 1e3].
  double slip_begins_per_s = 0.5, slip_ends_per_s = 2.0;
  double bump_begins_per_s = 0.3, bump_ends_per_s = 5.0;
  double slip_bump_per_s = 0.2;                                   ///< slip to bump and back
  double incline_begins_per_s = 0.001, incline_ends_per_s = 0.1;  ///< from and to the level
  double rough_begins_per_s = 0.02, rough_ends_per_s = 0.1;
  double event_shortest_s = 0.06;  ///< least stay in slip or bump; bound [0, 10]
  // Rest.
  double rest_rate_rad_s = 0.02;  ///< bound (0, 10]
  double rest_force_m_s2 = 0.15;  ///< of a node's mean about its slow mean; bound (0, 100]
  double rest_time_s = 0.4;       ///< quiet for so long; bound [0, 100]
  // Gaps. Between two readings further apart than gap_from_s nothing is known of the force; the rate is taken to have
  // gone straight from the one to the other, give or take what an angular acceleration of gap_acceleration_rad_s2 does.
  double gap_from_s = 0.06;               ///< bound (0, 1]
  double gap_max_s = 1.0;                 ///< a longer one ends the run; bound (0, 1]
  double gap_acceleration_rad_s2 = 15.0;  ///< bound (0, 1e4]
  /// A first reading that turns faster than this was taken in motion: attitude and velocity are then known by that much
  /// less; bound (0, 10].
  double start_rate_rad_s = 0.1;
  /// By how much more than this the horizontal sigma grows in an event that is called uncertain; bound (0, 1e3].
  double uncertain_m = 0.03;
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
