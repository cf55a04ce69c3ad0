// SPDX-License-Identifier: BSD-3-Clause
// A robot's board: one quarter turn of a 29 cm sphere about y, seen by its gyro, is a quarter of its circumference
// along x.
#include <cmath>
#include <cstdio>
#include <tumble/attitude/strapdown.hpp>
#include <tumble/rolling/rolling_odometry.hpp>

int main() {
  const double pi = std::acos(-1.0);
  const tumble::Strapdown attitude{tumble::Strapdown::Params{}};
  const tumble::RollingOdometry rolling{tumble::RollingOdometry::Params{}};
  tumble::Strapdown::State attitude_state;
  tumble::RollingOdometry::State rolling_state;
  for (int k = 0; k <= 125; ++k) {
    tumble::ImuSample sample;
    sample.time_ns = k * tumble::TimeNs{8'000'000};
    sample.angular_velocity_rad_s = {0.0, 0.5 * pi, 0.0};
    sample.specific_force_m_s2 = {0.0, 0.0, 9.80665};  // only the first is used: it levels the attitude
    if (!attitude.step(sample, attitude_state).ok()) return 1;
    if (!rolling.step(sample.time_ns, sample.angular_velocity_rad_s, attitude_state.q_WI, rolling_state).ok()) return 1;
  }
  std::printf("position %.4f m\n", rolling_state.p_WG_m.x());
}
