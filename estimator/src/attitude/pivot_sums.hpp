// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/common/types.hpp"

namespace tumble {

/// PivotMotionFit is a fitted rotation about a body point (pivot) that moves at constant velocity: imu_merge.md (I27).
struct PivotMotionFit {
  double residual_m_s = 0.0;  ///< root mean square of the components of the unexplained velocity
  double gravity_m_s2 = 0.0;  ///< magnitude of the fitted specific force that is constant in world axes
  double arm_m = 0.0;         ///< distance from the pivot to the IMU
};

class PivotMotionSums {
 public:
  /// `at_s` is the time from the start of the first reading to the middle of the added reading. Cost: O(1).
  void add(double at_s, double dt_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
    const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate_rad_s);
    const Eigen::Quaterniond middle = rotation_ * half;
    const Eigen::Vector3d gained = dt_s * (middle * force_m_s2);
    const Eigen::Vector3d velocity = velocity_ + 0.5 * gained;
    velocity_ += gained;
    rotation_ = (middle * half).normalized();
    const Eigen::Matrix3d by_arm = middle.toRotationMatrix() * so3::hat(rate_rad_s);
    sample_count_ += 1.0;
    time_sum_ += at_s;
    squared_time_sum_ += at_s * at_s;
    squared_velocity_sum_ += velocity.squaredNorm();
    arm_jacobian_sum_ += by_arm;
    time_arm_jacobian_sum_ += at_s * by_arm;
    squared_arm_jacobian_sum_ += by_arm.transpose() * by_arm;
    velocity_sum_ += velocity;
    time_velocity_sum_ += at_s * velocity;
    arm_velocity_sum_ += by_arm.transpose() * velocity;
  }

  PivotMotionFit fit() const {
    constexpr double kArm = 0.01;  // regularisation [s^-2] that keeps the lever arm short if the body hardly rotates
    using Nine = Eigen::Matrix<double, 9, 1>;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 9, 9> normal;
    normal << squared_time_sum_ * one, time_arm_jacobian_sum_, time_sum_ * one, time_arm_jacobian_sum_.transpose(),
        squared_arm_jacobian_sum_ + kArm * one, arm_jacobian_sum_.transpose(), time_sum_ * one, arm_jacobian_sum_,
        sample_count_ * one;
    Nine right;
    right << time_velocity_sum_, arm_velocity_sum_, velocity_sum_;
    const Nine x = normal.ldlt().solve(right);
    const double left = std::max(0.0, squared_velocity_sum_ - x.dot(right));
    return {std::sqrt(left / std::max(1.0, sample_count_)), x.head<3>().norm(), x.segment<3>(3).norm()};
  }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  /// time integral of the specific force, in sensor axes at the start
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  double sample_count_ = 0.0, time_sum_ = 0.0, squared_time_sum_ = 0.0, squared_velocity_sum_ = 0.0;
  Eigen::Matrix3d arm_jacobian_sum_ = Eigen::Matrix3d::Zero(), time_arm_jacobian_sum_ = Eigen::Matrix3d::Zero(),
                  squared_arm_jacobian_sum_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d velocity_sum_ = Eigen::Vector3d::Zero(), time_velocity_sum_ = Eigen::Vector3d::Zero(),
                  arm_velocity_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace tumble
