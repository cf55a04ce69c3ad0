// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// ratio of displacements measured by the lidar to displacements measured by the IMU
struct LidarScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t velocity_change_count = 0;  ///< number of compared velocity changes

  /// Returns true if the scale differs from 1 by more than 2 % and by more than five standard deviations.
  bool is_inconsistent() const;
  Status verdict() const;
};

/// Estimates the scale of the lidar's ranges over the sweeps of a run, by a robust regression (Huber, 1964) of velocity
/// changes. The velocity changes from the lidar poses, over two consecutive spans of 0.4 s, are compared with the
/// integrated acceleration of the IMU. Spans with a saturated accelerometer or with unconstrained sweeps are skipped.
/// Without acceleration, the scale is not observable. The standard deviation includes the correlation of overlapping
/// spans (Newey and West, 1987), and an acceleration error of 0.05 m/s^2 from bias and tilt. Cost: O(N).
LidarScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepReport> sweeps,
                            double gravity_m_s2);

/// Estimates the scale of the lidar's ranges live, from at most 1000 velocity changes of the last minute.
class LidarScaleEstimator {
 public:
  /// change of velocity from one time span to the next
  struct VelocityChange {
    TimeNs time_ns = 0;
    Eigen::Vector3d imu_velocity_change_m_s = Eigen::Vector3d::Zero(),
                    lidar_velocity_change_m_s = Eigen::Vector3d::Zero();
  };

  /// The buffer for `samples_max` samples should cover two seconds; with more samples between two sweeps, the sweep is
  /// skipped.
  LidarScaleEstimator(double gravity_m_s2, std::size_t samples_max);

  /// The samples must be in time order, with flags of saturated axes. No memory is allocated.
  void add(const ImuSample& sample);
  /// Call add() for all samples up to the end of the sweep first. Cost: O(changes).
  void add(const SweepReport& sweep);

  const LidarScale& scale() const { return scale_; }

 private:
  double gravity_m_s2_;
  std::size_t samples_max_;
  std::vector<ImuSample> samples_;
  std::deque<SweepReport> sweeps_;  ///< sweeps of two spans; only pose, attitudes and verdict
  std::deque<VelocityChange> velocity_changes_;
  LidarScale scale_;
};

}  // namespace tumble
