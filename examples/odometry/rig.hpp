// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <tumble/tumble.hpp>

/// Returns the sensors and mounting of tumbling.cpp, for the other programs.
inline tumble::TumblingOdometry::Params rig() {
  tumble::TumblingOdometry::Params params;
  params.imu = tumble::sheets::mti30();
  params.lidar = tumble::sheets::rs16();
  params.lever_arm_I_m = {-0.022, -0.085, 0.055};
  params.T_IL.translation() << 0.02014, 0.08745, 0.0398;
  params.T_IL.linear() = Eigen::AngleAxisd(-0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  params.own_body_L = {Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};
  return params;
}
