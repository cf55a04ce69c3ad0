// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct TriadDelay {
  double delay_s = 0.0;
  double sigma_s = 0.0;  ///< standard deviation of `delay_s`; 0: not estimated, or only an initial value
  bool operator==(const TriadDelay&) const = default;
};

/// Estimates the delay between gyro and accelerometer from impacts. For each delay of -4 to +4 samples, the class
/// correlates the angular acceleration with the specific force: rate_smoother.md (R45).
struct ImpactDelayCorrelation {
  static constexpr int kDelayMax_samples = 4, kDelaysPerSample = 8, kDelayMax = kDelayMax_samples * kDelaysPerSample,
                       kDelayCount = 2 * kDelayMax + 1;
  using DelayGrid = Eigen::Matrix<double, kDelayCount, 1>;

  /// Number of intervals between unsaturated gyro readings; sums over these intervals of the angular acceleration and
  /// of its square.
  double intervals = 0.0, acceleration_sum = 0.0, acceleration_squared = 0.0;
  /// Sums for each tested delay: specific force, squared force, force times angular acceleration, number of intervals
  /// with and without impact.
  DelayGrid force = DelayGrid::Zero(), force_squared = DelayGrid::Zero(), correlation_sum = DelayGrid::Zero(),
            impacts = DelayGrid::Zero(), flying = DelayGrid::Zero();

  /// Returns false for an interval without motion, which is ignored.
  static bool counts(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& after_rad_s);
  /// Adds an interval between two gyro readings. The arguments are the mean angular acceleration, and the mean
  /// magnitude of the specific force for each tested delay. Cost: O(kDelayCount).
  void add(double acceleration_rad_s2, const DelayGrid& force_m_s2);
  void decay_sums(double share);
  /// Returns the delay with the highest correlation, for samples that are `period_s` apart. `slower_s` is the longer
  /// one of the update periods of gyro and accelerometer. If the correlation is too low, sigma_s is 0. Cost:
  /// O(kDelayCount).
  TriadDelay estimate_delay(double period_s, double slower_s) const;
  /// Returns the correlation for the tested delay that is nearest to `delay_s`. Cost: O(1).
  double force_correlation_at(double delay_s, double period_s) const;

  bool operator==(const ImpactDelayCorrelation&) const = default;
};

/// Estimates the delay between gyro and accelerometer, up to four samples, from impacts or from free flight. Cost: O(N)
/// for each of about 100 tested delays.
///
/// The delay from impacts maximises the correlation between two signals: the square root of the angular acceleration's
/// magnitude, and the square root of the specific force's magnitude. A delay from impacts requires a correlation of at
/// least 0.6. The standard deviation of the delay from impacts is 0.15 sensor periods.
///
/// In free flight, the returned delay minimises the residual of the rigid-body model of the specific force: alpha x t +
/// w x (w x t) + bias, for angular acceleration alpha, rate w and lever arm t. For each tested delay, a robust fit
/// (Geman-McClure) estimates bias and lever arm. The lever arm has the prior mean `lever_arm_m` and the prior standard
/// deviation 0.02 m. The returned delay is 0 if fewer than 20 unclipped gyro readings exceed 2 rad/s, or if no
/// other delay fits clearly better.
TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Eigen::Vector3d& lever_arm_m);

}  // namespace tumble
