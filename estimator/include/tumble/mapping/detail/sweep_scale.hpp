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

/// sweep_scale.hpp compares the scale of the lidar's ranges with the IMU.
namespace tumble {

/// SweepScale is the ratio of displacements between sweeps to the displacements that the IMU measured.
struct SweepScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t changes = 0;  ///< number of compared velocity changes

  /// Returns whether the scale differs from 1 by more than 2 % and by more than five standard deviations.
  bool is_off() const;
  /// Returns `out_of_range` with the scale and the violated limit if is_off(), otherwise `ok`.
  Status verdict() const;
};

/// Estimates the scale of the lidar's ranges over the sweeps of a run. Cost: O(N). The function compares the mean
/// velocities of two consecutive spans of 0.4 s. The difference of the two mean velocities equals the integrated
/// acceleration, from gravity in flight and from impacts, for any velocity. The function regresses the lidar's velocity
/// differences on the IMU's velocity differences robustly (Huber, 1964); the expected slope is 1. Ranges that are 10 %
/// too long give a slope of 1.1, reduced by the weight of the IMU in the mapper. The attitudes come from the estimate
/// of the run. Intervals with a saturated accelerometer or with unconstrained sweeps are skipped. The standard
/// deviation of the slope is heteroscedasticity-consistent (White, 1980). `gravity_m_s2` is the magnitude of gravity.
/// Without acceleration, the scale is not observable. RestGravity detects an accelerometer's scale error from gravity
/// at rest.
SweepScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepReport> sweeps,
                            double gravity_m_s2);

/// Estimates the scale of the lidar's ranges while samples and sweeps arrive, from the newest 1000 changes of velocity.
/// SweepScaleWatch uses the first pose of each sweep, and is therefore less accurate than find_sweep_scale() with the
/// final poses of a whole run.
class SweepScaleWatch {
 public:
  /// Change is the change of velocity from one span to the next span.
  struct Change {
    Eigen::Vector3d by_imu_m_s = Eigen::Vector3d::Zero(), by_sweeps_m_s = Eigen::Vector3d::Zero();
  };

  /// Buffers `samples_max` samples, which should cover two seconds. If more than `samples_max` samples arrive between
  /// sweeps, nothing is compared.
  SweepScaleWatch(double gravity_m_s2, std::size_t samples_max);

  /// Adds an IMU sample in time order, with its saturated axes flagged. The function does not allocate.
  void add(const ImuSample& sample);
  /// Adds a sweep of the mapper, as soon as all samples up to the end of the sweep are added. Cost: O(changes).
  void add(const SweepReport& sweep);

  const SweepScale& scale() const { return scale_; }

  /// Passes every member of the state to the visitor. The source file state_visitor.hpp defines the function.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  double gravity_m_s2_;
  std::size_t samples_max_;
  std::vector<ImuSample> samples_;
  std::deque<SweepReport> sweeps_;  ///< sweeps of two spans; only pose, attitudes and verdict
  std::deque<Change> changes_;
  SweepScale scale_;
};

}  // namespace tumble
