// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble::testing {

/// ClippedSpin is a body that spins about its level x axis at base + more sin^2 for some time; its gyro clips at the
/// base, and its accelerometer may be saturated throughout.
struct ClippedSpin {
  double base_rad_s = 3.0, more_rad_s = 0.0, from_s = 5.0, lasts_s = 1.2, duration_s = 11.2;
  bool blind = true;

  bool within(double t) const { return t > from_s && t < from_s + lasts_s; }
  double rate(double t) const {
    if (!within(t)) return base_rad_s;
    const double s = std::sin(std::numbers::pi * (t - from_s) / lasts_s);
    return base_rad_s + more_rad_s * s * s;
  }
  double angle(double t) const {
    const double u = std::clamp((t - from_s) / lasts_s, 0.0, 1.0);
    return base_rad_s * t +
           more_rad_s * lasts_s * (0.5 * u - std::sin(2.0 * std::numbers::pi * u) / (4.0 * std::numbers::pi));
  }
};

/// SpinReadings contains the readings of its IMU.
struct SpinReadings {
  static constexpr double kHz = 100.0;
  std::vector<ImuSample> samples;
  std::vector<ClipSigns> signs;

  explicit SpinReadings(const ClippedSpin& spin) {
    for (int k = 1; k <= static_cast<int>(kHz * spin.duration_s); ++k) {
      const double end = k / kHz, t = end - 0.5 / kHz;
      ImuSample sample;
      ClipSigns sign;
      sample.time_ns = static_cast<TimeNs>(std::llround(end * 1e9));
      sample.angular_velocity_rad_s = {spin.rate(t), 0.0, 0.0};
      sample.specific_force_m_s2 = {0.0, kGravity_m_s2 * std::sin(spin.angle(t)),
                                    kGravity_m_s2 * std::cos(spin.angle(t))};
      if (spin.within(t)) {
        sample.angular_velocity_rad_s.x() = spin.base_rad_s;
        sign.gyro[0] = 1;
        if (spin.blind) {
          sample.specific_force_m_s2.setConstant(-15.0);
          sign.accel = {1, 1, 1};
        }
      }
      samples.push_back(sample);
      signs.push_back(sign);
    }
  }
  SensingAxisClipSigns clipped() const {
    SensingAxisClipSigns out;
    out.clip_signs = signs;
    return out;
  }
};

}  // namespace tumble::testing
