// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble {

/// TriadDelay is the delay of a device's accelerometer relative to its gyro.
struct TriadDelay {
  double delay_s = 0.0;
  double sigma_s = 0.0;  ///< 0: no information, or only an initial value
  bool operator==(const TriadDelay&) const = default;
};

/// ImpactSums correlates angular acceleration and force at impacts, for each tried delay. The tried delays are up to
/// four samples to either side, in steps of an eighth of a sample. See docs/maths/rate_smoother.md (R45).
struct ImpactSums {
  static constexpr int kDelayMax_samples = 4, kDelaysPerSample = 8, kDelayMax = kDelayMax_samples * kDelaysPerSample,
                       kDelayCount = 2 * kDelayMax + 1;
  using DelayGrid = Eigen::Matrix<double, kDelayCount, 1>;

  /// Number, sum and sum of squares of the angular acceleration x over intervals between adjacent unsaturated gyro
  /// readings.
  double intervals = 0.0, acceleration_sum = 0.0, acceleration_squared = 0.0;
  /// Sums per tried delay: sum and sum of squares of the force z, sum of products x z, intervals with an impact,
  /// intervals almost without force.
  DelayGrid force = DelayGrid::Zero(), force_squared = DelayGrid::Zero(), product = DelayGrid::Zero(),
            impacts = DelayGrid::Zero(), flying = DelayGrid::Zero();

  /// Returns whether the body moves in an interval between two rates; only intervals with motion are counted.
  static bool counts(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& after_rad_s);
  /// Adds an interval with mean angular acceleration [rad/s^2] and mean norm of the force per tried delay [m/s^2].
  /// Cost: O(kDelayCount).
  void add(double acceleration_rad_s2, const DelayGrid& force_m_s2);
  /// Multiplies the weight of all earlier intervals by `share`.
  void decay(double share);
  /// Returns the delay with the best correlation, for samples that are `period_s` apart. If gyro and accelerometer
  /// update at different rates, the slower sensor updates every `slower_s`. The returned sigma_s is 0 if the delay is
  /// not accepted. Cost: O(kDelayCount).
  TriadDelay estimate_delay(double period_s, double slower_s) const;
  /// Returns the correlation at the tried delay nearest to `delay_s`, for any number of impacts. Cost: O(1).
  double correlation_at(double delay_s, double period_s) const;

  bool operator==(const ImpactSums&) const = default;
};

}  // namespace tumble
