// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/common/so3.hpp"

namespace tumble {

/// PivotFit is a fitted rotation about a body point (pivot) that moves at constant velocity: imu_merge.md (I27).
struct PivotFit {
  double residual_m_s = 0.0;  ///< root mean square of the components of the unexplained velocity
  double gravity_m_s2 = 0.0;  ///< magnitude of the constant force in world axes
  double arm_m = 0.0;         ///< distance from the pivot to the sensor
};

class PivotSums {
 public:
  /// `at_s` is the time from the start of the first reading to the middle of this reading. Cost: O(1).
  void add(double at_s, double dt_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
    const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate_rad_s);
    const Eigen::Quaterniond middle = turned_ * half;
    const Eigen::Vector3d gained = dt_s * (middle * force_m_s2);
    const Eigen::Vector3d velocity = velocity_ + 0.5 * gained;
    velocity_ += gained;
    turned_ = (middle * half).normalized();
    const Eigen::Matrix3d by_arm = middle.toRotationMatrix() * so3::hat(rate_rad_s);
    n_ += 1.0;
    t_ += at_s;
    tt_ += at_s * at_s;
    vv_ += velocity.squaredNorm();
    a_ += by_arm;
    ta_ += at_s * by_arm;
    aa_ += by_arm.transpose() * by_arm;
    v_ += velocity;
    tv_ += at_s * velocity;
    av_ += by_arm.transpose() * velocity;
  }

  PivotFit fit() const {
    constexpr double kArm = 0.01;  // s^-2: keeps the lever arm short if the body hardly rotates
    using Nine = Eigen::Matrix<double, 9, 1>;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 9, 9> normal;
    normal << tt_ * one, ta_, t_ * one, ta_.transpose(), aa_ + kArm * one, a_.transpose(), t_ * one, a_, n_ * one;
    Nine right;
    right << tv_, av_, v_;
    const Nine x = normal.ldlt().solve(right);
    const double left = std::max(0.0, vv_ - x.dot(right));
    return {std::sqrt(left / std::max(1.0, n_)), x.head<3>().norm(), x.segment<3>(3).norm()};
  }

 private:
  Eigen::Quaterniond turned_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< integral of the forces, in sensor axes at the start
  double n_ = 0.0, t_ = 0.0, tt_ = 0.0, vv_ = 0.0;
  Eigen::Matrix3d a_ = Eigen::Matrix3d::Zero(), ta_ = Eigen::Matrix3d::Zero(), aa_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d v_ = Eigen::Vector3d::Zero(), tv_ = Eigen::Vector3d::Zero(), av_ = Eigen::Vector3d::Zero();
};

}  // namespace tumble
