// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "sim/lidar/lidar_simulation.hpp"

namespace tumble::sim {

/// The true pose between the samples of a motion: position linear in time, attitude turning at a constant rate about a
/// fixed axis. With samples 0.5 ms apart that leaves a dt^2 / 8 = 3e-8 s^2 times the acceleration: 13 um at 400 m/s^2.
/// Beyond the last sample its last interval goes on. For ascending times; keeps the interval it is in.
class TrackCursor {
 public:
  /// `motion` has at least two samples and must outlive the cursor.
  explicit TrackCursor(const MotionTrack& motion) : motion_(motion) {}

  void seek(std::int64_t time_ns) {
    if (time_ns < start_ns_ || time_ns >= end_ns_) enter_interval(time_ns);
    into_ = static_cast<double>(time_ns - start_ns_) * per_ns_;
    const double angle2 = into_ * into_ * turn2_;
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
    first_ = into_ * sinc;
    second_ = into_ * into_ * cosc;
  }

  Eigen::Vector3d to_world(const Eigen::Vector3d& direction_B) const {
    const Eigen::Vector3d across = turn_rad_.cross(direction_B);
    return R_WB_ * (direction_B + first_ * across + second_ * turn_rad_.cross(across));
  }
  Eigen::Vector3d position_m() const { return p_WB_m_ + into_ * step_m_; }

 private:
  void enter_interval(std::int64_t time_ns) {
    const auto last = static_cast<std::int64_t>(motion_.p_WB_m.size()) - 2;
    const std::int64_t k = std::clamp<std::int64_t>(time_ns / motion_.period_ns, 0, last);
    const auto i = static_cast<std::size_t>(k);
    start_ns_ = k * motion_.period_ns;
    end_ns_ = k == last ? INT64_MAX : start_ns_ + motion_.period_ns;
    per_ns_ = 1.0 / static_cast<double>(motion_.period_ns);
    p_WB_m_ = motion_.p_WB_m[i];
    step_m_ = motion_.p_WB_m[i + 1] - p_WB_m_;
    R_WB_ = motion_.q_WB[i].toRotationMatrix();
    Eigen::Quaterniond relative = motion_.q_WB[i].conjugate() * motion_.q_WB[i + 1];
    if (relative.w() < 0.0) relative.coeffs() = -relative.coeffs();
    // atan2 keeps its precision at small angles, where acos loses it
    const double sine = relative.vec().norm();
    turn_rad_ = sine > 0.0 ? Eigen::Vector3d(relative.vec() * (2.0 * std::atan2(sine, relative.w()) / sine))
                           : Eigen::Vector3d::Zero();
    turn2_ = turn_rad_.squaredNorm();
  }

  MotionTrack motion_;
  std::int64_t start_ns_ = 0, end_ns_ = 0;
  double per_ns_ = 0.0, into_ = 0.0, turn2_ = 0.0, first_ = 0.0, second_ = 0.0;
  Eigen::Vector3d p_WB_m_ = Eigen::Vector3d::Zero(), step_m_ = Eigen::Vector3d::Zero(),
                  turn_rad_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity();
};

}  // namespace tumble::sim
