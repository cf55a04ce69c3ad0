// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble {

/// How much later than the gyro the accelerometer of a device says the same instant.
struct TriadDelay {
  double delay_s = 0.0;
  double sigma_s = 0.0;  ///< 0: the readings tell nothing, or no more than a place to start from
  bool operator==(const TriadDelay&) const = default;
};

/// How the turns of a struck body correlate with the force, for each of the delays tried: up to four samples to either
/// side, in steps of an eighth. docs/maths/rate_smoother.md (R44).
struct StrokeSums {
  static constexpr int kMostSamples = 4, kPerSample = 8, kMost = kMostSamples * kPerSample, kTried = 2 * kMost + 1;
  using Tried = Eigen::Matrix<double, kTried, 1>;

  /// Of intervals between free readings of the gyro beside each other: their number, sum and squares of x.
  double intervals = 0.0, turn = 0.0, turn_squared = 0.0;
  /// Of each delay: sum and squares of z, of the products with x; intervals that met a stroke, that met hardly a force.
  Tried force = Tried::Zero(), force_squared = Tried::Zero(), product = Tried::Zero(), strokes = Tried::Zero(),
        flying = Tried::Zero();

  /// Whether an interval between two rates counts: the body moves.
  static bool counts(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& after_rad_s);
  /// Takes an interval: mean angular acceleration [rad/s^2], and the force's mean norm by delay [m/s^2]. O(kTried).
  void add(double turn_rad_s2, const Tried& force_m_s2);
  /// Lets what was taken count for `share` of what it did.
  void forget(double share);
  /// The delay of the best correlation, of samples `period_s` apart and a slower triad that reads every `slower_s`;
  /// sigma 0 where it is not believed. O(kTried).
  TriadDelay told(double period_s, double slower_s) const;
  /// Correlation at the tried delay nearest to one, whatever strokes there were. O(1).
  double correlation_at(double delay_s, double period_s) const;

  bool operator==(const StrokeSums&) const = default;
};

}  // namespace tumble
