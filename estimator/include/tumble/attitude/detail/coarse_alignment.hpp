// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/common/detail/scalar_update.hpp"

namespace tumble {

/// Returns the smallest rotation that turns the unit vector `up_W` to the z axis; the rotation keeps the heading. If
/// `up_W` is opposite to z, the result is a half turn about x.
inline Eigen::Quaterniond levelling(const Eigen::Vector3d& up_W) {
  const double w = std::sqrt(std::max(0.0, 0.5 * (1.0 + up_W.z())));
  if (w < 1e-6) return {0.0, 1.0, 0.0, 0.0};
  return Eigen::Quaterniond(w, 0.5 * up_W.y() / w, -0.5 * up_W.x() / w, 0.0).normalized();
}

/// Estimates the vertical from the mean specific force of a moving body after the attitude was lost: attitude.md (A19),
/// (A20). The method needs no initial attitude, because it uses no linearisation. The caller adds the variance of the
/// gyro's angle error to `tilt_variance_growth_rad2`.
struct CoarseAlignment {
  bool running = false;
  double time_s = 0.0;
  double start_velocity_variance_m2_s2 = 0.0;
  double start_tilt_variance_rad2 = 0.0;
  double tilt_variance_growth_rad2 = 0.0;  ///< increase of the tilt's variance since the start, because of gyro errors
  Eigen::Vector3d integrated_force_W_m_s = Eigen::Vector3d::Zero();
  bool operator==(const CoarseAlignment&) const = default;

  void start_alignment(double velocity_variance_m2_s2, double tilt_variance_rad2) {
    *this = {};
    running = true;
    start_velocity_variance_m2_s2 = velocity_variance_m2_s2;
    start_tilt_variance_rad2 = tilt_variance_rad2;
  }

  /// Adds `more_W_m_s`, the specific force integrated over `length_s`, in world axes.
  void add(const Eigen::Vector3d& more_W_m_s, double length_s) {
    integrated_force_W_m_s += more_W_m_s;
    time_s += length_s;
  }

  /// Returns the variance of the tilt per axis without the correction by levelling().
  double tilt_rad2() const { return start_tilt_variance_rad2 + tilt_variance_growth_rad2; }

  /// Returns the variance of the tilt per axis after levelling(), which results from the unknown velocities at start
  /// and end and from gyro errors.
  double variance_rad2(double velocity_variance_m2_s2, double gravity_m_s2) const {
    const double gravity_m_s = gravity_m_s2 * std::max(time_s, 1e-9);
    const double seen = squared(integrated_force_W_m_s.norm() - gravity_m_s);
    return std::max(start_velocity_variance_m2_s2 + velocity_variance_m2_s2, seen) / squared(gravity_m_s) +
           tilt_variance_growth_rad2;
  }

  /// Returns the rotation in world axes that turns the mean specific force upwards and keeps the heading.
  Eigen::Quaterniond levelling() const { return tumble::levelling(integrated_force_W_m_s.normalized()); }
  double mean_force_tilt_rad() const {
    return std::atan2(integrated_force_W_m_s.head<2>().norm(), integrated_force_W_m_s.z());
  }
};

}  // namespace tumble
