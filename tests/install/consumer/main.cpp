// SPDX-License-Identifier: BSD-3-Clause
// Simulates a robot's board: after a second of rest, a body turns by half a turn about y, theta(t) = pi/2 (1 - cos(pi
// t)), measured by an IMU at its centre of mass. The program integrates the estimated angular velocity.
#include <cmath>
#include <cstdio>
#include <optional>
#include <tumble/angular_velocity/rate_stream.hpp>
#include <vector>

int main() {
  const double pi = std::acos(-1.0), period_s = 0.008;
  tumble::AngularRateStream::Params params;
  params.model.nominal.lever_arm_m.setZero();
  params.period_s = period_s;
  const tumble::AngularRateStream stream(params);
  const tumble::AngularRateStream copy = stream;
  tumble::AngularRateStream::State state = stream.start();
  std::optional<tumble::AngularRateState> rate;
  std::vector<tumble::AngularRateState> rates;
  for (int k = 0; k <= 250; ++k) {
    const double t_s = std::fmax(0.0, (k - 125) * period_s), theta_rad = 0.5 * pi * (1.0 - std::cos(pi * t_s));
    tumble::ImuSample sample;
    sample.time_ns = k * tumble::TimeNs{8'000'000};
    sample.angular_velocity_rad_s = {0.0, 0.5 * pi * pi * std::sin(pi * t_s), 0.0};
    sample.specific_force_m_s2 = {-std::sin(theta_rad) * 9.80665, 0.0, std::cos(theta_rad) * 9.80665};
    if (!copy.push(sample, state, rate).ok()) return 1;
    if (rate) rates.push_back(*rate);
  }
  stream.flush(state, rates);
  double turned_rad = 0.0;
  for (const tumble::AngularRateState& at : rates) turned_rad += at.w_WI_I_rad_s.y() * period_s;
  std::printf("turned %.2f rad in %zu samples\n", turned_rad, rates.size());
}
