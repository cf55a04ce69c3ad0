// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

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
