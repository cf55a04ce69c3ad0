// SPDX-License-Identifier: BSD-3-Clause
// Runs both odometry classes on one second of a stationary sensor.
#include <cstdio>
#include <tumble/tumble.hpp>

int main() {
  tumble::RollingOdometry::Params sphere;
  sphere.radius_m = 0.145;
  sphere.imus.push_back({tumble::sheets::phidget1044()});
  tumble::RollingOdometry rolling(sphere);
  tumble::TumblingOdometry::Params rig;
  rig.lever_arm_I_m.setZero();  // the IMU is at the centre of mass
  tumble::TumblingOdometry tumbling(rig);
  tumble::ImuSample sample;
  sample.specific_force_m_s2 = {0.0, 0.0, 9.80665};
  for (int k = 1; k <= 100; ++k) {
    sample.time_ns = k * tumble::TimeNs{10'000'000};
    if (!rolling.add_imu(sample).ok() || !tumbling.add_imu(sample).ok()) return 1;
  }
  std::printf("at rest: %d, rate %.3f rad/s\n", rolling.newest()->at_rest, tumbling.newest_rate()->w_WI_I_rad_s.norm());
}
