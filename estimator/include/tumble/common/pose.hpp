// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tumble/common/time.hpp"

namespace tumble {

/// attitude of a sensor or body A in the world frame W at one time
struct AttitudeState {
  TimeNs time_ns = 0;
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  /// covariance of the attitude error phi in world axes, with q_true = Exp(phi) * q_WA; zero if not estimated
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();
};

/// pose and velocity of a frame A in the world frame W at one time
struct PoseState {
  TimeNs time_ns = 0;
  Eigen::Vector3d position_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_W_m_s = Eigen::Vector3d::Zero();
  /// Covariance of the position error [m] and the attitude error phi [rad], both in world axes; zero if not estimated.
  /// The attitude error is defined by q_true = Exp(phi) * q_WA.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace tumble
