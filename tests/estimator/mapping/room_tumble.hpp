// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Sensor data of one tumble through a box room with pillars, and how the odometry is run over it.
namespace tumble::test {

LidarInertialOdometry::Params rig_params();

struct RoomTumble {
  Motion motion;
  std::vector<ImuSample> imu;
  std::vector<std::vector<LidarPoint>> sweeps;
};
/// Of 26 sweeps; made once.
const RoomTumble& room_tumble();

/// What a method reports that believes a gyro with a rail.
RateState clipped_rate(const ImuSample& sample, double rail_rad_s);

/// The samples of one sweep.
void feed_imu(LidarInertialOdometry& odometry, int sweep, double rail_rad_s = 1e9);
Status add_sweep(LidarInertialOdometry& odometry, int sweep, std::span<const LidarPoint> points,
                 LidarInertialOdometry::SweepReport& report);
/// Sweeps `from` to `to` - 1 with their samples.
std::vector<LidarInertialOdometry::SweepReport> run(LidarInertialOdometry& odometry, int from, int to,
                                                    double rail_rad_s = 1e9);

struct PoseError {
  double m, rad, m_s;
};
PoseError error_of(const PoseState& pose);

/// Bit for bit, poses and what is said of the sweep.
bool same(const LidarInertialOdometry::SweepReport& a, const LidarInertialOdometry::SweepReport& b);

}  // namespace tumble::test
