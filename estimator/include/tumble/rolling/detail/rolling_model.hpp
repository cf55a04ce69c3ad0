// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/types.hpp"

namespace tumble {

inline constexpr int kContactModes = 5;

/// Returns true if the contact point may move along the floor in the contact mode `mode`.
inline bool may_slip(ContactMode mode) {
  return mode == ContactMode::slip || mode == ContactMode::bump_or_flight;
}

/// Pose of a rolling sphere's centre G at one sample, with the contact mode.
struct RollingEstimate {
  TimeNs time_ns = 0;
  Eigen::Vector3d sphere_centre_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sphere_velocity_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();  ///< gyro reading minus estimated bias
  /// covariance of the position error [m] and the attitude error [rad], in world axes
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// covariance of the velocity of the sphere's centre, in IMU axes
  Eigen::Matrix3d velocity_covariance_I_m2_s2 = Eigen::Matrix3d::Zero();
  ContactMode mode = ContactMode::grip;
  bool at_rest = false;
  bool position_uncertain =
      false;  ///< the position is uncertain after a slip or bump: ContactModeParams::kEventSigmaGrowth_m
};

/// Nominal motion and calibration, about which the error-state Kalman filters are linearised.
struct RollingNominalState {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d accel_scale = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gyro_scale = Eigen::Matrix3d::Zero();
  double accel_delay_s = 0.0;
  Eigen::Vector3d lever_arm_error_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d floor_slope = Eigen::Vector2d::Zero();  ///< horizontal part of the floor's unit normal, in world axes
  double radius_error_m = 0.0;
  Eigen::Vector3d last_rate_I_rad_s = Eigen::Vector3d::Zero();
  bool operator==(const RollingNominalState&) const = default;
};

/// Constants that one run estimated, as prior for a later run of the same sphere. Their order is that of the error
/// state, from the gyro bias to the radius: rolling.md (R1).
struct RollingCalibration {
  static constexpr int kSize = 31;
  Eigen::Matrix<double, kSize, 1> constants = Eigen::Matrix<double, kSize, 1>::Zero();
  Eigen::Matrix<double, kSize, kSize> covariance = Eigen::Matrix<double, kSize, kSize>::Zero();
};

/// Integrals of attitude, specific force, rate and their products since the last measurement update (node).
struct RollingNodeIntegrals {
  Eigen::Matrix3d integrated_rotation_s = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d integrated_rotation_with_force_s =
      Eigen::Matrix3d::Zero();  ///< integral of the rotation matrix over the readings with unsaturated force
  Eigen::Vector3d force_integral_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 9> rotation_by_force_integral = Eigen::Matrix<double, 3, 9>::Zero(),
                              rotation_rate_integral = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d rate_cross_force_integral_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_integral_I_rad = Eigen::Vector3d::Zero(), force_integral_I_m_s = Eigen::Vector3d::Zero();
  double squared_rate_integral_rad2_s = 0.0;
  double rate_clipped_s = 0.0,
         force_clipped_s = 0.0;  ///< duration of saturated gyro readings; of saturated accelerometer readings
  double recovered_rate_s = 0.0;
  double impact_m_s = 0.0;  ///< integral of | |f| - g |, with specific force f, as far as above its usual level
  double unexplained_impact_m_s = 0.0;  ///< part of impact_m_s that rotation does not explain
  Eigen::Vector3d partial_saturation_W_m_s = Eigen::Vector3d::Zero();  ///< standard deviation due to short saturation
  // Duration of a gap between readings, and variances that the gap adds to angle, rate (times duration) and velocity.
  double gap_s = 0.0, gap_angle_variance_rad2 = 0.0, gap_rate_variance_rad2_s = 0.0, gap_speed_variance_m2_s2 = 0.0;
  double node_interval_s = 0.0;
  bool operator==(const RollingNodeIntegrals&) const = default;
};

}  // namespace tumble
