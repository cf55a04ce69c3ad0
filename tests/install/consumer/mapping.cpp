// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <tumble/mapping/lidar_inertial_odometry.hpp>

int main() {
  tumble::LidarInertialOdometry odometry{tumble::LidarInertialOdometry::Params{}};
  tumble::LidarInertialOdometry::SweepResult report;
  const tumble::Status status = odometry.add_sweep(0, 100'000'000, {}, report);
  std::printf("%s\n", tumble::to_string(status.error_code));
}
