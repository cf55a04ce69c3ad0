// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/tumble.hpp"
#include "tumble_ros/node_params.hpp"
#include "tumble_ros/publisher.hpp"
#include "tumble_ros/schedule.hpp"

namespace tumble::ros {

/// RollingAdapter connects RollingOdometry to the messages of a robot. RollingAdapter contains the logic of the ROS
/// node and needs no ROS. The adapter publishes the estimates unchanged.
///
/// Publisher::odometry receives the smoothed poses, which are lag_s old (live poses if lag_s is 0).
/// Publisher::odometry_imu receives the newest pose after each accepted sample. The base frame turns with the sphere.
/// The covariance of the angular velocity comes from the white noise in the first IMU's data sheet.
class RollingAdapter {
 public:
  using Params = RollingAdapterParams;

  /// Throws InvalidParams like RollingOdometry. `publisher` must outlive the adapter.
  RollingAdapter(const Params& params, Publisher& publisher);

  /// Processes a sample of an IMU. Returns the status of RollingOdometry::add_imu().
  Status on_imu(std::size_t unit, const ImuSample& sample);
  /// Starts a new run. `T_OB` gives position and heading of the sphere.
  void reset(const Eigen::Isometry3d& T_OB);
  const RollingOdometry& odometry() const { return odometry_; }

 private:
  Odometry odometry_of(const RollingOdometry::Pose& sphere) const;
  void publish_diagnostics(TimeNs time_ns);

  std::size_t units_;
  Publisher& publisher_;
  RollingOdometry odometry_;
  double rate_variance_rad2_s2_;
  Rejections imu_;
  Schedule diagnostics_;
  TimeNs newest_ns_ = 0;  ///< stamp of the last published newest pose
};

}  // namespace tumble::ros
