// SPDX-License-Identifier: BSD-3-Clause
// Simulates a robot's board: after a second of rest, a 29 cm sphere rolls half a turn about y without slip, theta(t) =
// pi/2 (1 - cos(pi t)), measured by an IMU at its centre, which is half of its circumference along x.
#include <cmath>
#include <cstdio>
#include <memory>
#include <tumble/attitude/strapdown.hpp>
#include <tumble/rolling/rolling_filter.hpp>

int main() {
  const double pi = std::acos(-1.0), radius_m = 0.145, gravity_m_s2 = 9.80665;
  const tumble::Strapdown attitude{tumble::Strapdown::Params{}};
  tumble::RollingParams params;
  params.radius_m = radius_m;
  const tumble::RollingFilter rolling{params};
  tumble::Strapdown::State attitude_state;
  const auto rolling_state = std::make_unique<tumble::RollingFilter::State>();
  for (int k = 0; k <= 250; ++k) {
    const double t_s = std::fmax(0.0, (k - 125) * 0.008);
    const double theta_rad = 0.5 * pi * (1.0 - std::cos(pi * t_s));
    const double acceleration_m_s2 = t_s > 0.0 ? radius_m * 0.5 * pi * pi * pi * std::cos(pi * t_s) : 0.0;
    tumble::ImuSample sample;
    sample.time_ns = k * tumble::TimeNs{8'000'000};
    sample.angular_velocity_rad_s = {0.0, 0.5 * pi * pi * std::sin(pi * t_s), 0.0};
    sample.specific_force_m_s2 = {std::cos(theta_rad) * acceleration_m_s2 - std::sin(theta_rad) * gravity_m_s2, 0.0,
                                  std::sin(theta_rad) * acceleration_m_s2 + std::cos(theta_rad) * gravity_m_s2};
    if (!attitude.step(sample, attitude_state).ok()) return 1;
    if (!rolling.step(sample, *rolling_state).ok()) return 1;
  }
  const Eigen::Vector3d x_W = attitude_state.q_WI * Eigen::Vector3d::UnitX();
  std::printf("turned %.2f rad, position %.2f m\n", std::acos(std::fmax(-1.0, x_W.x())),
              rolling_state->sphere_centre_W_m.x());
}
