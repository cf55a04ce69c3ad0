// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "tumble/common/time.hpp"

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

/// Pose of a rolling sphere's centre G at one sample, with what is known of the contact.
struct RollingEstimate {
  TimeNs time_ns = 0;
  Eigen::Vector3d p_WG_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WG_m_s = Eigen::Vector3d::Zero();
  /// Of (position error [m], attitude error [rad]), W, at the node that follows.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  RollingMode mode = RollingMode::grip;
  bool at_rest = false;
  bool uncertain =
      false;  ///< in an event that the position's sigma grew by more than RollingModeParams::uncertain_m in
};

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
  double rotated_rad2_s = 0.0;
  double rate_clipped_s = 0.0, force_clipped_s = 0.0;  ///< with a reading that says nothing
  double recovered_s = 0.0;                            ///< with a rate that was recovered
  double impact_m_s = 0.0;                             ///< of | |f| - g | beyond the usual
  double unexplained_impact_m_s = 0.0;                 ///< the same without what the turning may explain
  Eigen::Vector3d subsample_saturation_W_m_s =
      Eigen::Vector3d::Zero();  ///< sigma of what a rail took unseen, along the force
  // of a gap: its length, variance of the turning, of the rate times time, and of the velocity
  double gap_s = 0.0, gap_rad2 = 0.0, gap_rate_rad2_s = 0.0, gap_speed_m2_s2 = 0.0;
  double node_s = 0.0;
  bool operator==(const RollingSums&) const = default;
};

}  // namespace tumble
