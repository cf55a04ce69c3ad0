// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// room_tumble.hpp provides the sensor data of one tumble through a box room with pillars, and runs the odometry on it.
namespace tumble::test {

LidarInertialOdometry::Params rig_params();

struct RoomTumble {
  Motion motion;
  std::vector<ImuSample> imu;
  std::vector<std::vector<LidarPoint>> sweeps;
};
/// Returns a tumble of 26 sweeps, which is generated once.
const RoomTumble& room_tumble();

/// Returns the rate of a method that accepts the readings of a saturated gyro.
AngularRateState clipped_rate(const ImuSample& sample, double rail_rad_s);

/// Adds the IMU samples of one sweep.
void feed_imu(LidarInertialOdometry& odometry, int sweep, double rail_rad_s = 1e9);
Status add_sweep(LidarInertialOdometry& odometry, int sweep, std::span<const LidarPoint> points,
                 LidarInertialOdometry::SweepResult& report);
/// Adds sweeps `from` to `to` - 1 with their samples.
std::vector<LidarInertialOdometry::SweepResult> run(LidarInertialOdometry& odometry, int from, int to,
                                                    double rail_rad_s = 1e9);

struct PoseError {
  double m, rad, m_s;
};
PoseError error_of(const PoseState& pose);

/// Compares poses and verdict of the sweep bit for bit.
bool same(const LidarInertialOdometry::SweepResult& a, const LidarInertialOdometry::SweepResult& b);

}  // namespace tumble::test
