// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>
#include <tumble/tumble.hpp>

#include "driver.hpp"

int main() {
  tumble::TumblingOdometry::Params params;
  params.imu = tumble::sheets::mti30();  // or what your data sheet says
  params.lidar = tumble::sheets::rs16();
  params.lever_arm_I_m = {-0.022, -0.085, 0.055};         // from the centre of mass to the IMU, to a centimetre
  params.T_IL.translation() << 0.02014, 0.08745, 0.0398;  // lidar to IMU, to half a degree and some millimetres
  params.T_IL.linear() = Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  params.own_body_L = {Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};
  tumble::TumblingOdometry odometry(params);
  while (const auto message = driver::next(std::cin)) {
    const auto& sweep = message->sweep;
    const tumble::Status status =
        message->imu ? odometry.add_imu(*message->imu) : odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points);
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());  // left out, the rest goes on
    while (const auto done = odometry.take()) driver::print(*done);
  }
  odometry.finish();
  while (const auto done = odometry.take()) driver::print(*done);
  std::fprintf(stderr, "a map of %zu points\n", odometry.mapper().map().size());
}
