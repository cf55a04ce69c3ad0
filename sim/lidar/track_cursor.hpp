// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/lidar/lidar_simulation.hpp"

namespace tumble::sim {

/// Pose and its rate of change at one instant: T_WB(t + dt) is (R_WB + dt dR_WB, p_WB + dt v_WB) up to (rate dt)^2 / 2.
struct MovingPose {
  Eigen::Matrix3d R_WB, dR_WB_s;
  Eigen::Vector3d p_WB_m, v_WB_m_s;
};

/// The true pose between the samples of a motion: position linear in time, attitude turning at a constant rate about a
/// fixed axis. With samples 0.5 ms apart that leaves a dt^2 / 8 = 3e-8 s^2 times the acceleration: 13 um at 400 m/s^2.
/// Beyond the last sample its last interval goes on. For ascending times; keeps the interval it is in.
class TrackCursor {
 public:
  /// `motion` has at least two samples and must outlive the cursor.
  explicit TrackCursor(const MotionTrack& motion) : motion_(motion) {}

  MovingPose at(std::int64_t time_ns) {
    if (time_ns < start_ns_ || time_ns >= end_ns_) enter_interval(time_ns);
    const double into = static_cast<double>(time_ns - start_ns_) * per_ns_;
    const double angle2 = into * into * turn_rad_.squaredNorm();
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
    MovingPose pose;
    pose.R_WB = R_WB_ * (Eigen::Matrix3d::Identity() + into * sinc * cross_ + into * into * cosc * cross_ * cross_);
    pose.dR_WB_s = pose.R_WB * cross_ * per_s_;
    pose.p_WB_m = p_WB_m_ + into * step_m_;
    pose.v_WB_m_s = step_m_ * per_s_;
    return pose;
  }

  /// Whether one pose of constant rate holds from `from_ns` up to and including `to_ns`. Not before at(from_ns).
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
    p_WB_m_ = motion_.p_WB_m[i];
    step_m_ = motion_.p_WB_m[i + 1] - p_WB_m_;
    R_WB_ = motion_.q_WB[i].toRotationMatrix();
    Eigen::Quaterniond relative = motion_.q_WB[i].conjugate() * motion_.q_WB[i + 1];
    if (relative.w() < 0.0) relative.coeffs() = -relative.coeffs();
    // atan2 keeps its precision at small angles, where acos loses it
    const double sine = relative.vec().norm();
    turn_rad_ = sine > 0.0 ? Eigen::Vector3d(relative.vec() * (2.0 * std::atan2(sine, relative.w()) / sine))
                           : Eigen::Vector3d::Zero();
    cross_ << 0.0, -turn_rad_.z(), turn_rad_.y(), turn_rad_.z(), 0.0, -turn_rad_.x(), -turn_rad_.y(), turn_rad_.x(),
        0.0;
  }

  MotionTrack motion_;
  std::int64_t start_ns_ = 0, end_ns_ = 0;
  double per_ns_ = 0.0, per_s_ = 0.0;
  Eigen::Vector3d p_WB_m_ = Eigen::Vector3d::Zero(), step_m_ = Eigen::Vector3d::Zero(),
                  turn_rad_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity(), cross_ = Eigen::Matrix3d::Zero();
};

}  // namespace tumble::sim
