// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <tumble/tumble.hpp>

#include "driver.hpp"  // yours: reads the sensors and prints poses

int main() {
  tumble::TumblingOdometry::Params params;
  params.imu = tumble::sheets::mti30();  // range, rate and noise of the IMU; or your own tumble::ImuDataSheet
  params.lidar = tumble::sheets::rs16();
  params.lever_arm_I_m = {-0.022, -0.085, 0.055};                 // centre of mass to IMU, within 1 cm
  params.T_IL = Eigen::Translation3d(0.02014, 0.08745, 0.0398) *  // lidar to IMU, within 1 cm and 0.5 degrees
                Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitZ());
  params.own_body_L = {Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};  // the robot's own returns
  tumble::TumblingOdometry odometry(params);
  while (const auto message = driver::next(std::cin)) {
    driver::add(*message, odometry);  // calls odometry.add_imu() or odometry.add_sweep()
    while (const auto sweep = odometry.take()) driver::print(*sweep);
  }
  odometry.finish();
  while (const auto sweep = odometry.take()) driver::print(*sweep);
}
