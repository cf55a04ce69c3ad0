// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Sensor data of a tumble through a box room with pillars, and a function that runs the odometry.
namespace tumble::test {

LidarInertialOdometry::Params rig_params();

struct RoomTumble {
  Motion motion;
  std::vector<ImuSample> imu;
  std::vector<std::vector<LidarPoint>> sweeps;
};
/// Returns the data of 26 sweeps, which are generated once.
const RoomTumble& room_tumble();

/// Returns the rates of a method that ignores gyro saturation.
RateState clipped_rate(const ImuSample& sample, double rail_rad_s);

/// Returns the samples of a sweep.
void feed_imu(LidarInertialOdometry& odometry, int sweep, double rail_rad_s = 1e9);
Status add_sweep(LidarInertialOdometry& odometry, int sweep, std::span<const LidarPoint> points,
                 LidarInertialOdometry::SweepReport& report);
/// Returns the sweeps `from` to `to` - 1 with their samples.
std::vector<LidarInertialOdometry::SweepReport> run(LidarInertialOdometry& odometry, int from, int to,
                                                    double rail_rad_s = 1e9);

struct PoseError {
  double m, rad, m_s;
};
PoseError error_of(const PoseState& pose);

/// Compares poses and reports of sweeps bit by bit.
bool same(const LidarInertialOdometry::SweepReport& a, const LidarInertialOdometry::SweepReport& b);

}  // namespace tumble::test
