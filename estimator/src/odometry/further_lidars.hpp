// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {

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
