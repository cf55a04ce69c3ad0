// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Ratio of displacements measured by the lidar to displacements measured by the IMU.
struct LidarScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t velocity_change_count = 0;

  /// Returns true if the ratio differs from 1 by more than 2 % and by more than five standard deviations.
  bool is_inconsistent() const;
  Status verdict() const;
};

/// Estimates the scale of the lidar's ranges over the sweeps of a run. Velocity changes from lidar poses, between two
/// consecutive intervals of 0.4 s, are compared with the integrated acceleration of the IMU by robust regression
/// (Huber, 1964). Intervals with a saturated accelerometer or with unconstrained sweeps are skipped. Without
/// acceleration, the scale is not observable. The standard deviation includes the correlation of overlapping intervals
/// (Newey and West, 1987), and the acceleration errors from the bias (0.05 m/s^2) and from the tilt's uncertainty.
/// Cost: O(N).
LidarScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepResult> sweeps,
                            double gravity_m_s2);

/// Estimates the scale of the lidar's ranges live, from at most 1000 velocity changes of the last minute.
class LidarScaleEstimator {
 public:
  /// Change of the mean velocity from one interval of 0.4 s to the next.
  struct VelocityChange {
    TimeNs time_ns = 0;
    Eigen::Vector3d imu_velocity_change_m_s = Eigen::Vector3d::Zero(),
                    lidar_velocity_change_m_s = Eigen::Vector3d::Zero();
    double acceleration_sigma_m_s2 = 0.0;  ///< constant error of the IMU's acceleration, from bias and tilt
  };

  /// `samples_max` is the size of the buffer for IMU samples, which should cover two seconds. A sweep with more samples
  /// since the previous sweep is skipped.
  LidarScaleEstimator(double gravity_m_s2, std::size_t samples_max);

  /// Adds an IMU sample with clip flags. Time stamps must increase. No memory is allocated.
  void add(const ImuSample& sample);
  /// Adds the report of a sweep, after all IMU samples up to the end of the sweep. Cost: O(number of stored velocity
  /// changes).
  void add(const SweepResult& sweep);

  const LidarScale& scale() const { return scale_; }

 private:
  double gravity_m_s2_;
  std::size_t samples_max_;
  std::vector<ImuSample> samples_;
  std::deque<SweepResult> sweeps_;  ///< sweeps of the last two intervals; contains only pose, attitudes and verdict
  std::deque<VelocityChange> velocity_changes_;
  LidarScale scale_;
};

/// Detects tracking failure from the sweep reports of LidarInertialOdometry (docs/maths/mapping.md, heading
/// "Localisation check"). Tracking has failed if the standard deviation of the position exceeds the maximum distance of
/// matched points. Tracking has also failed if the registered poses of two or more sweeps contradict the inertial
/// prediction, or if few points of many sweeps fit the map. Localisation does not detect a map of wrong scale
/// (LidarScale), or errors of the lidar's pose or time offset that the calibration absorbs.
class Localisation {
 public:
  static constexpr double kForgettingTime_s = 30.0;

  /// `matched_m` is the maximum distance of matched points (MatchingParams::distance_m).
  explicit Localisation(double matched_m) : distance_when_localised_m_(matched_m) {}

  /// Adds the report of a sweep with a pose. Sweeps must be in time order. Cost: O(1).
  void add(const SweepResult& sweep);

  /// Returns `out_of_range` with the violated limit if tracking has ever failed.
  Status verdict() const;
  /// Returns `out_of_range` with the violated limit if the position is uncertain now, or if registered poses
  /// contradicted the inertial prediction within the last kForgettingTime_s.
  Status current_verdict() const;
  /// Returns the time of the first sweep of the current tracking failure.
  std::optional<TimeNs> lost_since_ns() const {
    return lost_since_ns_ ? lost_since_ns_ : previous_contradicted_sweep_ns_;
  }

 private:
  void observe_fit(const SweepResult& sweep);
  Status fit_verdict() const;

  double distance_when_localised_m_;
  bool map_started_ = false;
  double largest_sigma_m_ = 0.0, largest_innovation_ = 0.0, second_largest_innovation_ = 0.0;
  std::size_t aligned_sweeps_ = 0;  ///< number of sweeps in the means below
  double mean_inlier_ratio_ = 0.0, mean_innovation_ = 0.0;
  double smallest_inlier_ratio_ = 1.0;  ///< smallest mean inlier ratio that failed the check
  double sigma_m_ = 0.0;                ///< newest position relative to the map
  TimeNs newest_ns_ = 0;
  std::optional<TimeNs> lost_since_ns_;  ///< first sweep of the current period with an uncertain position
  std::optional<TimeNs> last_contradicted_sweep_ns_,
      previous_contradicted_sweep_ns_;  ///< last two sweeps whose registered pose contradicts the inertial prediction
};

}  // namespace tumble
