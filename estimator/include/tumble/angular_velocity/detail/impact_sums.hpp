// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble {

struct TriadDelay {
  double delay_s = 0.0;
  double sigma_s = 0.0;  ///< 0: no estimate, or only an initial value
  bool operator==(const TriadDelay&) const = default;
};

/// ImpactDelayCorrelation correlates angular acceleration and force at impacts, for delays of -4 to +4 samples between
/// gyro and accelerometer: rate_smoother.md (R45).
struct ImpactDelayCorrelation {
  static constexpr int kDelayMax_samples = 4, kDelaysPerSample = 8, kDelayMax = kDelayMax_samples * kDelaysPerSample,
                       kDelayCount = 2 * kDelayMax + 1;
  using DelayGrid = Eigen::Matrix<double, kDelayCount, 1>;

  /// number of intervals between unsaturated gyro readings, and sums of their angular acceleration and its square
  double intervals = 0.0, acceleration_sum = 0.0, acceleration_squared = 0.0;
  /// sums for each tested delay: force, squared force, force times angular acceleration, intervals with and without
  /// impact
  DelayGrid force = DelayGrid::Zero(), force_squared = DelayGrid::Zero(), correlation_sum = DelayGrid::Zero(),
            impacts = DelayGrid::Zero(), flying = DelayGrid::Zero();

  /// Intervals without motion are ignored.
  static bool counts(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& after_rad_s);
  /// Adds an interval with its mean angular acceleration [rad/s^2] and its mean force magnitude for each tested delay
  /// [m/s^2]. Cost: O(kDelayCount).
  void add(double acceleration_rad_s2, const DelayGrid& force_m_s2);
  void decay_sums(double share);
  /// Returns the delay with the best correlation, for samples that are `period_s` apart. `slower_s` is the update
  /// period of the slower sensor. The returned sigma_s is 0 if no delay is accepted. Cost: O(kDelayCount).
  TriadDelay estimate_delay(double period_s, double slower_s) const;
  /// Returns the correlation at the tested delay that is nearest to `delay_s`. Cost: O(1).
  double force_correlation_at(double delay_s, double period_s) const;

  bool operator==(const ImpactDelayCorrelation&) const = default;
};

}  // namespace tumble
