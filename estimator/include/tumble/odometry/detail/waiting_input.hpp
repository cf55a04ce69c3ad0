// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {

inline constexpr double kLidarSilent_s = 1.0;  ///< after this time without a sweep, an empty sweep is inserted

/// Sweep that waits until the rates of its IMU samples are estimated.
struct WaitingSweep {
  TimeNs start_ns = 0, end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Odometer readings that wait until their sweep is registered. A copy contains the complete state.
class WaitingReadings {
 public:
  /// maximum number of waiting readings: 500 Hz over the longest time without a sweep (1 s) plus a lag of 1 s
  static constexpr std::size_t kReadingsMax = 1024;
  /// time by which an odometer reading may extend beyond its sweep, because clocks differ
  static constexpr auto kExtrapolation_ns = static_cast<TimeNs>(1e9 * SweepTrajectory::kExtrapolation_s);

  /// Stores an odometer reading; readings may arrive in any order. The reading's time must be after `done_ns`, the end
  /// of the last registered sweep, and at most `latest_ns`. Returns an error of check_odometer_reading(), `time_order`
  /// if the reading's sweep is already registered, or `out_of_range` (time after `latest_ns`, or more than `most`
  /// waiting readings).
  Status add(const OdometerReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most = kReadingsMax);

  /// Returns the last odometer reading within a sweep, and deletes all readings up to `end_ns`. Earlier readings of the
  /// sweep are not used, because the errors of successive readings are correlated.
  std::optional<OdometerReading> take_readings_in(TimeNs from_ns, TimeNs end_ns);

  /// Returns the last odometer reading within a sweep, like take_readings_in(), but keeps all readings. Cost: O(log n).
  std::optional<OdometerReading> find(TimeNs from_ns, TimeNs end_ns) const;

 private:
  std::deque<OdometerReading> waiting_readings_;  ///< sorted by the middle of the reading's time interval
};

/// Adds the points of further lidars to the sweeps of the first lidar. FurtherLidars transforms each point to axes of
/// the first lidar, and adds the point to the sweep during which the point was measured.
class FurtherLidars {
 public:
  FurtherLidars() = default;
  /// Throws InvalidParams for a non-finite pose, range or time offset, for swapped corners of an own-body box, or for a
  /// time offset above 1 s. `T_IL_first` is the pose of the first lidar in the IMU frame.
  FurtherLidars(std::span<const FurtherLidar> lidars, const Eigen::Isometry3d& T_IL_first);

  /// `lidar` is the number of the further lidar, starting at 1. See TumblingOdometry::add_sweep(). If more than `most`
  /// sweeps are stored, FurtherLidars drops the oldest sweep.
  Status add(std::size_t lidar, TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, TimeNs latest_ns,
             std::size_t most);
  /// Adds the stored points that were measured during a sweep to the sweep, and drops earlier points. Cost: O(stored
  /// points).
  void merge_into(WaitingSweep& sweep);

 private:
  std::vector<FurtherLidar> lidars_;
  Eigen::Isometry3d T_first_lidar_imu_ = Eigen::Isometry3d::Identity();
  std::deque<WaitingSweep> waiting_sweeps_;  ///< points in axes of the first lidar
};

}  // namespace tumble
