// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/attitude/detail/tilt.hpp"
#include "tumble/common/detail/squared.hpp"

namespace tumble {

/// Which way is up when all that was known of it is lost, of a body that goes on moving: the coarse alignment of
/// inertial navigation. In axes that the gyro carries on, the integral of the specific force is gravity's and the
/// change of the velocity, and the first grows with time while the second does not. attitude.md (A10c), (A10d).
/// Not linear: it finds up from upside down as well. Not modelled: the gyro's error (the caller adds it).
struct CoarseAlignment {
  bool running = false;
  double time_s = 0.0;
  double velocity_m2_s2 = 0.0;                            ///< variance of the velocity when it began, one axis
  double lost_rad2 = 0.0;                                 ///< the tilt's variance then, one axis
  double grown_rad2 = 0.0;                                ///< and by what it has grown since
  Eigen::Vector3d force_W_m_s = Eigen::Vector3d::Zero();  ///< integral since
  bool operator==(const CoarseAlignment&) const = default;

  void begin(double velocity_variance_m2_s2, double tilt_variance_rad2) {
    *this = {};
    running = true;
    velocity_m2_s2 = velocity_variance_m2_s2;
    lost_rad2 = tilt_variance_rad2;
  }

  /// `more_W_m_s`: integral of the specific force over `length_s`.
  void add(const Eigen::Vector3d& more_W_m_s, double length_s) {
    force_W_m_s += more_W_m_s;
    time_s += length_s;
  }

  /// Variance of the tilt without it, one axis.
  double tilt_rad2() const { return lost_rad2 + grown_rad2; }

  /// The same of what `levelling()` gives: by the velocities at both ends, of which the length of the mean force
  /// shows a part, and by the gyro meanwhile.
  double variance_rad2(double velocity_variance_m2_s2, double gravity_m_s2) const {
    const double gravity_m_s = gravity_m_s2 * std::max(time_s, 1e-9);
    const double seen = squared(force_W_m_s.norm() - gravity_m_s);
    return std::max(velocity_m2_s2 + velocity_variance_m2_s2, seen) / squared(gravity_m_s) + grown_rad2;
  }

  /// Rotation of W that makes the mean force point up; turns no heading in. And its angle.
  Eigen::Quaterniond levelling() const { return tumble::levelling(force_W_m_s.normalized()); }
  double off_rad() const { return std::atan2(force_W_m_s.head<2>().norm(), force_W_m_s.z()); }
};

}  // namespace tumble
