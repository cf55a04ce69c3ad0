// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/common/types.hpp"

/// hand_held_motion.hpp is a hand-held body in closed form, similar to a twirled wand: Exp(a(t) x) Exp(b(t) y) with a
/// spin a about its long axis, far beyond the gyro's saturation level for tenths of a second, and a slow tilt b; the
/// hand moves on sines of some decimetres. The readings are those at the middle of their window.
namespace tumble::testing {

struct HandHeldMotion {
  double spin_rad = 3.0;  ///< amplitude of a: rates up to spin_rad * 2 pi spin_hz
  double spin_hz = 0.6;
  double tilt_rad = 0.5;
  double tilt_hz = 0.31;
  double hand_m = 0.1;
  double hand_hz = 0.5;
  double gravity_m_s2 = 9.80665;
  Eigen::Vector3d lever_arm_m = {0.02, 0.01, 0.01};

  Eigen::Quaterniond attitude(double t) const {
    return so3::exp({0.0, tilt(t, 0), 0.0}) * so3::exp({spin(t, 0), 0.0, 0.0});
  }
  /// Returns the rate in sensor axes: R = Ry(b) Rx(a).
  Eigen::Vector3d rate(double t) const {
    const double a = spin(t, 0);
    return {spin(t, 1), tilt(t, 1) * std::cos(a), -tilt(t, 1) * std::sin(a)};
  }
  Eigen::Vector3d angular_acceleration(double t) const {
    const double a = spin(t, 0), da = spin(t, 1), db = tilt(t, 1), ddb = tilt(t, 2);
    return {spin(t, 2), ddb * std::cos(a) - db * da * std::sin(a), -ddb * std::sin(a) - db * da * std::cos(a)};
  }
  Eigen::Vector3d hand_acceleration(double t) const {
    const double w = 2.0 * std::numbers::pi * hand_hz;
    return -hand_m * w * w * Eigen::Vector3d(std::sin(w * t), 0.8 * std::cos(0.9 * w * t), 0.5 * std::sin(1.3 * w * t));
  }
  Eigen::Vector3d specific_force(double t) const {
    const Eigen::Vector3d w = rate(t), up(0.0, 0.0, gravity_m_s2);
    return attitude(t).conjugate() * (hand_acceleration(t) + up) + angular_acceleration(t).cross(lever_arm_m) +
           w.cross(w.cross(lever_arm_m));
  }

 private:
  static double sine(double amplitude, double hz, double t, int derivative) {
    const double w = 2.0 * std::numbers::pi * hz;
    return amplitude * std::pow(w, derivative) * std::sin(w * t + 0.5 * std::numbers::pi * derivative);
  }
  double spin(double t, int derivative) const { return sine(spin_rad, spin_hz, t, derivative); }
  double tilt(double t, int derivative) const { return sine(tilt_rad, tilt_hz, t, derivative); }
};

struct HandHeldRecording {
  std::vector<ImuSample> samples;
  std::vector<ClipSigns> signs;
  std::vector<Eigen::Vector3d> rate_rad_s;  ///< true, at the middle of each window
  std::vector<Eigen::Quaterniond> q_WI;     ///< true, at each stamp
};

/// Returns samples at `hz` for `duration_s`, with the gyro's x element clipped at `rail_rad_s` (0: none).
inline HandHeldRecording record(const HandHeldMotion& motion, double hz, double duration_s, double rail_rad_s) {
  HandHeldRecording out;
  for (int k = 1; k <= static_cast<int>(hz * duration_s); ++k) {
    const double end = k / hz, centre = end - 0.5 / hz;
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(std::llround(end * 1e9));
    sample.angular_velocity_rad_s = motion.rate(centre);
    sample.specific_force_m_s2 = motion.specific_force(centre);
    out.rate_rad_s.push_back(sample.angular_velocity_rad_s);
    out.q_WI.push_back(motion.attitude(end));
    ClipSigns signs;
    double& x = sample.angular_velocity_rad_s.x();
    if (rail_rad_s > 0.0 && std::abs(x) > rail_rad_s) {
      signs.gyro[0] = x > 0.0 ? 1 : -1;
      x = signs.gyro[0] * rail_rad_s;
    }
    out.samples.push_back(sample);
    out.signs.push_back(signs);
  }
  return out;
}

/// Each third saturated reading has wrapped to the opposite sign; its clip sign is `sign`.
inline HandHeldRecording with_wraps(const HandHeldRecording& recording, std::int8_t sign) {
  HandHeldRecording out = recording;
  int at_rail = 0;
  for (std::size_t k = 0; k < out.samples.size(); ++k) {
    if (out.signs[k].gyro[0] == 0 || ++at_rail % 3 != 0) continue;
    out.samples[k].angular_velocity_rad_s.x() *= -1.0;
    out.signs[k].gyro[0] = sign;
  }
  return out;
}

}  // namespace tumble::testing
