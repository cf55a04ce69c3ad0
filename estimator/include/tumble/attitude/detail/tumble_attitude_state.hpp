// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/attitude/detail/coarse_alignment.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

struct TumbleAttitudeState {
  static constexpr int kStates = 10;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector2d v_W_m_s = Eigen::Vector2d::Zero();
  Eigen::Vector2d displacement_W_m = Eigen::Vector2d::Zero();
  /// Covariance of the errors in this order: tilt error (phi_x, phi_y) in world axes, bias in IMU axes, velocity,
  /// displacement, heading error phi_z. The attitude error is defined by q_true = Exp(phi) q_WI.
  Covariance covariance = Covariance::Zero();
  ImuAverage average;  ///< average of the readings that are not yet processed
  Eigen::Matrix3d recovered_covariance_rad2_s2 = Eigen::Matrix3d::Zero();   ///< mean rate covariance in `average`
  Eigen::Quaterniond last_processed_q_WI = Eigen::Quaterniond::Identity();  ///< attitude at the last processed average
  // integrals since the last node
  Eigen::Matrix3d integrated_rotation_matrix_s = Eigen::Matrix3d::Zero();
  Eigen::Vector3d force_integral_W_m_s = Eigen::Vector3d::Zero();
  double squared_rate_integral_rad2_s = 0.0;
  Eigen::Vector2d recovered_angle_variance_rad2 =
      Eigen::Vector2d::Zero();  ///< variances of tilt and heading due to recovered rates
  double time_since_node_s = 0.0;
  Eigen::Vector2d recovered_angle_sigma_sum_rad =
      Eigen::Vector2d::Zero();           ///< sum of the standard deviations of recovered rates
  double velocity_variance_m2_s2 = 0.0;  ///< variance of the body's velocity, per axis
  double displacement_variance_m2 = 0.0;
  CoarseAlignment alignment;
  RestDetector::State stationary_state;
  bool at_rest = false;
  // state of a rolling sphere
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< rate of the last sample, minus the bias
  double slip_duration_s = 0.0, grip_duration_s = 0.0;
  bool slipping = false;
  TimeNs last_time_ns = 0;
  bool started = false;
  bool operator==(const TumbleAttitudeState&) const = default;
};

}  // namespace tumble
