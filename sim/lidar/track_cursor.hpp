// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/lidar/lidar_simulation.hpp"

namespace tumble::sim {

using Pose34 = Eigen::Matrix<double, 3, 4>;

/// TrackCursor interpolates the true pose of a lidar between the samples of the body's motion. The position is
/// interpolated linearly, and the attitude turns at a constant rate about a fixed axis. With a sample interval of 0.5
/// ms and an acceleration of 400 m/s^2, the position error is 13 um (acceleration times squared sample interval / 8).
class TrackCursor {
 public:
  /// Interval contains the terms of Rodrigues' formula for the motion between two samples. K is the cross-product
  /// matrix of the body's rotation vector over the interval. `turned` is R_WB K T_BL, and `rotated_twice` is R_WB K K
  /// T_BL.
  struct Interval {
    std::int64_t start_ns = 0, end_ns = 0;
    double per_ns = 0.0, per_s = 0.0;
    double angle2 = 0.0;  ///< squared rotation angle over the whole interval
    Eigen::Vector3d step_m = Eigen::Vector3d::Zero();
    Pose34 start = Pose34::Zero(), turned = Pose34::Zero(), rotated_twice = Pose34::Zero();

    bool holds(std::int64_t time_ns) const { return time_ns >= start_ns && time_ns < end_ns; }
    double share(std::int64_t time_ns) const { return static_cast<double>(time_ns - start_ns) * per_ns; }
  };

  /// For squared rotation angles below kSmall2 (40 rad/s over 0.5 ms), the series of sin(a)/a and (1 - cos(a))/a^2 are
  /// accurate to 1e-16.
  static constexpr double kSmall2 = 4e-4;
  static double sinc_of_small(double angle2) {
    return 1.0 - angle2 / 6.0 * (1.0 - angle2 / 20.0 * (1.0 - angle2 / 42.0));
  }
  static double cosc_of_small(double angle2) {
    return 0.5 - angle2 / 24.0 * (1.0 - angle2 / 30.0 * (1.0 - angle2 / 56.0));
  }
  static double sinc_of(double angle2) { return std::sin(std::sqrt(angle2)) / std::sqrt(angle2); }
  static double cosc_of(double angle2) { return (1.0 - std::cos(std::sqrt(angle2))) / angle2; }

  /// `motion` must have at least two samples, and must outlive the TrackCursor.
  TrackCursor(const MotionTrack& motion, const Eigen::Isometry3d& T_BL) : motion_(motion) {
    T_BL_ << T_BL.linear(), T_BL.translation();
  }

  /// Returns the interval that contains the given time. The returned reference is valid until the next call.
  const Interval& interval(std::int64_t time_ns) {
    if (!now_.holds(time_ns)) enter_interval(time_ns);
    return now_;
  }

  Pose34 at(std::int64_t time_ns) {
    const Interval& now = interval(time_ns);
    const double share = now.share(time_ns), angle2 = share * share * now.angle2;
    const bool small = angle2 < kSmall2;
    const double first = share * (small ? sinc_of_small(angle2) : sinc_of(angle2));
    const double second = share * share * (small ? cosc_of_small(angle2) : cosc_of(angle2));
    Pose34 T_WL = now.start + first * now.turned + second * now.rotated_twice;
    T_WL.col(3) += share * now.step_m;
    return T_WL;
  }

 private:
  void enter_interval(std::int64_t time_ns) {
    const auto last = static_cast<std::int64_t>(motion_.p_WB_m.size()) - 2;
    const std::int64_t k = std::clamp<std::int64_t>(time_ns / motion_.period_ns, 0, last);
    const auto i = static_cast<std::size_t>(k);
    now_.start_ns = k * motion_.period_ns;
    now_.end_ns = k == last ? INT64_MAX : now_.start_ns + motion_.period_ns;
    now_.per_ns = 1.0 / static_cast<double>(motion_.period_ns);
    now_.per_s = 1e9 * now_.per_ns;
    now_.step_m = motion_.p_WB_m[i + 1] - motion_.p_WB_m[i];
    Eigen::Quaterniond relative = motion_.q_WB[i].conjugate() * motion_.q_WB[i + 1];
    if (relative.w() < 0.0) relative.coeffs() = -relative.coeffs();
    const double sine = relative.vec().norm();
    const Eigen::Vector3d rotation_rad =
        sine > 0.0 ? Eigen::Vector3d(relative.vec() * (2.0 * std::atan2(sine, relative.w()) / sine))
                   : Eigen::Vector3d::Zero();
    now_.angle2 = rotation_rad.squaredNorm();
    Eigen::Matrix3d K;
    K << 0.0, -rotation_rad.z(), rotation_rad.y(), rotation_rad.z(), 0.0, -rotation_rad.x(), -rotation_rad.y(),
        rotation_rad.x(), 0.0;
    const Eigen::Matrix3d R_WB = motion_.q_WB[i].toRotationMatrix();
    now_.start = R_WB * T_BL_;
    now_.turned = R_WB * K * T_BL_;
    now_.rotated_twice = R_WB * K * K * T_BL_;
    now_.start.col(3) += motion_.p_WB_m[i];
  }

  MotionTrack motion_;
  Pose34 T_BL_;
  Interval now_;
};

}  // namespace tumble::sim
