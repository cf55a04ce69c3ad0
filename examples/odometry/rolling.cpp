// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>
#include <tumble/tumble.hpp>
#include <vector>

#include "driver.hpp"

int main() {
  tumble::RollingOdometry::Params params;
  params.radius_m = 0.145;
  params.lag_s = 0.5;  // take() gives poses 0.5 s late and smoothed; newest() has the live pose
  for (const Eigen::Vector3d& p_m : {Eigen::Vector3d(0.08, 0.0, 0.01), {-0.04, 0.069, 0.01}, {-0.04, -0.069, 0.01}}) {
    params.imus.push_back({tumble::sheets::phidget1044()});  // three IMUs and their positions in the sphere
    params.imus.back().T_BI.translation() = p_m;
  }
  tumble::RollingOdometry odometry(params);
  std::vector<tumble::ImuSample> now;
  while (const auto message = driver::next(std::cin)) {
    if (message->imu) now.push_back(*message->imu);
    if (now.size() < params.imus.size()) continue;
    const tumble::Status status = odometry.add_imus(now);
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
    now.clear();
    while (const auto done = odometry.take()) driver::print(done->pose);
  }
  odometry.finish();
  while (const auto done = odometry.take()) driver::print(done->pose);
}
