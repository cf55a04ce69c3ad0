// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// room_rig.hpp runs the mapper in a synthetic room, sweep by sweep.
namespace tumble::test {

inline OdometryParams true_params() {
  OdometryParams params;
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  return params;
}

inline Motion slower() {
  Motion motion;
  motion.spin_rad_s = 6.0;
  motion.second_spin_rad_s = 2.0;
  return motion;
}

/// RoomRig is an odometry with its sensors and the truth.
struct RoomRig {
  explicit RoomRig(const OdometryParams& params, const Motion& m = slower(), const Room& r = Room::box_with_pillars())
      : odometry(params), motion(m), room(r), imu(make_imu(m, 7.0)) {}

  void feed_imu(int sweep, const Eigen::Vector3d& rate_error = Eigen::Vector3d::Zero()) {
    for (int k = sweep * kSamplesPerSweep; k < (sweep + 1) * kSamplesPerSweep; ++k) {
      AngularRateState rate = believe(imu[static_cast<std::size_t>(k)]);
      rate.w_WI_I_rad_s += rate_error;
      ASSERT_TRUE(odometry.add_imu(imu[static_cast<std::size_t>(k)], rate).ok());
    }
  }
  std::vector<LidarPoint> points(int sweep) const {
    return make_sweep(room, motion, true_params().T_IL, sweep, kRoomNoise_m, kHalfColumns);
  }
  Status sweep(int k, std::span<const LidarPoint> given) {
    return odometry.add_sweep(k * kSweep_ns, (k + 1) * kSweep_ns, given, report);
  }
  void run(int from, int to) {
    for (int k = from; k < to; ++k) {
      feed_imu(k);
      ASSERT_TRUE(sweep(k, points(k)).ok());
    }
  }
  double error_m() const {
    return (report.pose.position_W_m - motion.p_m(1e-9 * static_cast<double>(report.pose.time_ns))).norm();
  }

  LidarInertialOdometry odometry;
  SweepResult report;
  Motion motion;
  Room room;
  std::vector<ImuSample> imu;
};

}  // namespace tumble::test
