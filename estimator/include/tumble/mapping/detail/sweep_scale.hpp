// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/sweep_report.hpp"

/// The functions in sweep_scale.hpp compare the scale of the lidar's ranges with the IMU.
namespace tumble {

/// SweepScale is the ratio of displacements between sweeps to the displacements that the IMU measured.
struct SweepScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t changes = 0;  ///< number of compared velocity changes

  /// Returns whether the scale differs from 1 by more than 2 % and by more than five standard deviations.
  bool is_inconsistent() const;
  /// Returns `out_of_range` with the scale and the violated limit if is_inconsistent(), otherwise `ok`.
  Status verdict() const;
};

/// Estimates the scale of the lidar's ranges over the sweeps of a run. The function compares the mean velocities of two
/// consecutive spans of 0.4 s. The difference of the two velocities equals the integrated acceleration, from gravity in
/// flight and from impacts, for any velocity. A robust regression (Huber, 1964) of the lidar's velocity differences on
/// the IMU's differences has slope 1. Ranges 10 % too long give a slope of 1.1, reduced by the weight of the IMU in the
/// mapping. The attitudes come from the run's estimate. The function skips intervals with a saturated accelerometer or
/// with unconstrained sweeps. The standard deviation includes the correlation of overlapping changes (Newey and West,
/// 1987). The argument `gravity_m_s2` is the magnitude of gravity. Without acceleration, the scale is not observable.
/// The standard deviation includes a constant acceleration error of 0.05 m/s^2, from bias and tilt, which does not
/// average out over changes in one direction. Cost: O(N).
SweepScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepReport> sweeps,
                            double gravity_m_s2);

/// Estimates the scale of the lidar's ranges while samples and sweeps arrive. SweepScaleEstimator uses the velocity
/// changes of the last minute, at most 1000. SweepScaleEstimator uses the first pose of each sweep, so
/// find_sweep_scale() is more accurate.
class SweepScaleEstimator {
 public:
  /// Change is the change of velocity from one time span to the next.
  struct Change {
    TimeNs time_ns = 0;
    Eigen::Vector3d imu_change_m_s = Eigen::Vector3d::Zero(), sweeps_change_m_s = Eigen::Vector3d::Zero();
  };

  /// Constructs with a buffer for `samples_max` samples, which should cover two seconds. If more than `samples_max`
  /// samples arrive between sweeps, the estimator skips the comparison.
  SweepScaleEstimator(double gravity_m_s2, std::size_t samples_max);

  /// Adds an IMU sample in time order, with its saturated axes flagged. The function does not allocate.
  void add(const ImuSample& sample);
  /// Adds a sweep after all samples up to the end of the sweep. Cost: O(changes).
  void add(const SweepReport& sweep);

  const SweepScale& scale() const { return scale_; }

 private:
  double gravity_m_s2_;
  std::size_t samples_max_;
  std::vector<ImuSample> samples_;
  std::deque<SweepReport> sweeps_;  ///< sweeps of two spans; only pose, attitudes and verdict
  std::deque<Change> changes_;
  SweepScale scale_;
};

}  // namespace tumble
