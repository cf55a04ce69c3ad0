// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/lidar/lidar_simulation.hpp"

namespace tumble::sim {

/// Rotation and position side by side: T_WL is (R_WL, p_WL).
using Pose34 = Eigen::Matrix<double, 3, 4>;

/// The true pose of a lidar between the samples of its body's motion: the body's position is linear in time, its
/// attitude turns at a constant rate about a fixed axis. With samples 0.5 ms apart that leaves a dt^2 / 8 = 3e-8 s^2
/// times the acceleration: 13 um at 400 m/s^2. Beyond the last sample its last interval goes on. Keeps the interval it
/// is in, so that ascending times are cheap.
class TrackCursor {
 public:
  /// `motion` has at least two samples and must outlive the cursor.
  TrackCursor(const MotionTrack& motion, const Eigen::Isometry3d& T_BL) : motion_(motion) {
    T_BL_ << T_BL.linear(), T_BL.translation();
  }

  /// Pose at a time, and its rate of change per second.
  void at(std::int64_t time_ns, Pose34& T_WL, Pose34& rate_s) {
    if (time_ns < start_ns_ || time_ns >= end_ns_) enter_interval(time_ns);
    const double into = static_cast<double>(time_ns - start_ns_) * per_ns_;
    const double angle2 = into * into * turn2_;
    // sin(a)/a and (1 - cos(a))/a^2; the series are exact to 1e-16 at 0.02 rad, which is 40 rad/s over 0.5 ms
    double sinc, cosc;
    if (angle2 < 4e-4) {
      sinc = 1.0 - angle2 / 6.0 * (1.0 - angle2 / 20.0 * (1.0 - angle2 / 42.0));
      cosc = 0.5 - angle2 / 24.0 * (1.0 - angle2 / 30.0 * (1.0 - angle2 / 56.0));
    } else {
      const double angle = std::sqrt(angle2);
      sinc = std::sin(angle) / angle;
      cosc = (1.0 - std::cos(angle)) / angle2;
    }
    // Rodrigues: exp(x K) = I + first K + second K^2, and K^3 = -|turn|^2 K
    const double first = into * sinc, second = into * into * cosc;
    T_WL = start_ + first * turned_ + second * turned_twice_;
    T_WL.col(3) += into * step_m_;
    rate_s = per_s_ * ((1.0 - second * turn2_) * turned_ + first * turned_twice_);
    rate_s.col(3) += per_s_ * step_m_;
  }

  /// Whether one interval of constant rate holds from `from_ns` up to and including `to_ns`. After at() of a time
  /// between the two.
  bool is_smooth(std::int64_t from_ns, std::int64_t to_ns) const { return from_ns >= start_ns_ && to_ns < end_ns_; }

 private:
  void enter_interval(std::int64_t time_ns) {
    const auto last = static_cast<std::int64_t>(motion_.p_WB_m.size()) - 2;
    const std::int64_t k = std::clamp<std::int64_t>(time_ns / motion_.period_ns, 0, last);
    const auto i = static_cast<std::size_t>(k);
    start_ns_ = k * motion_.period_ns;
    end_ns_ = k == last ? INT64_MAX : start_ns_ + motion_.period_ns;
    per_ns_ = 1.0 / static_cast<double>(motion_.period_ns);
    per_s_ = 1e9 * per_ns_;
    step_m_ = motion_.p_WB_m[i + 1] - motion_.p_WB_m[i];
    Eigen::Quaterniond relative = motion_.q_WB[i].conjugate() * motion_.q_WB[i + 1];
    if (relative.w() < 0.0) relative.coeffs() = -relative.coeffs();
    // atan2 keeps its precision at small angles, where acos loses it
    const double sine = relative.vec().norm();
    const Eigen::Vector3d turn_rad =
        sine > 0.0 ? Eigen::Vector3d(relative.vec() * (2.0 * std::atan2(sine, relative.w()) / sine))
                   : Eigen::Vector3d::Zero();
    turn2_ = turn_rad.squaredNorm();
    Eigen::Matrix3d K;
    K << 0.0, -turn_rad.z(), turn_rad.y(), turn_rad.z(), 0.0, -turn_rad.x(), -turn_rad.y(), turn_rad.x(), 0.0;
    const Eigen::Matrix3d R_WB = motion_.q_WB[i].toRotationMatrix();
    start_ = R_WB * T_BL_;
    turned_ = R_WB * K * T_BL_;
    turned_twice_ = R_WB * K * K * T_BL_;
    start_.col(3) += motion_.p_WB_m[i];
  }

  MotionTrack motion_;
  Pose34 T_BL_;
  std::int64_t start_ns_ = 0, end_ns_ = 0;
  double per_ns_ = 0.0, per_s_ = 0.0, turn2_ = 0.0;
  Eigen::Vector3d step_m_ = Eigen::Vector3d::Zero();
  Pose34 start_ = Pose34::Zero(), turned_ = Pose34::Zero(), turned_twice_ = Pose34::Zero();
};

}  // namespace tumble::sim
