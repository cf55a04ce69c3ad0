// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>

namespace tumble::test {

inline constexpr double kStandardGravity_m_s2 = 9.80665;

/// A KnownMotion is a motion in closed form.
struct KnownMotion {
  std::function<Eigen::Quaterniond(double)> q_WI;  ///< attitude at a time in seconds from the start
  std::function<Eigen::Vector3d(double)> p_WI_m;
};

/// Returns the angular velocity in the body at `t`, rad/s: a central difference over 0.2 ms each way, exact to 1e-5
/// rad/s for motions below 10 Hz.
Eigen::Vector3d angular_velocity(const KnownMotion& motion, double t);
/// Returns the specific force in the body at `t`, m/s^2; gravity is standard; the difference is exact to 1e-3 m/s^2 as
/// above.
Eigen::Vector3d specific_force(const KnownMotion& motion, double t);

/// Returns zero before `begin`, one after `begin + length`, and between them the polynomial of fifth degree whose first
/// two derivatives vanish at both ends.
double smooth_step(double t, double begin, double length);
/// Returns one within (begin, end), with a smooth `ramp` at either end inside it, and zero outside.
double window(double t, double begin, double end, double ramp);

/// Noise is white noise that is the same on every machine and with every library (xorshift, sum of uniforms).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  /// Returns three numbers with this standard deviation.
  Eigen::Vector3d vector(double deviation);
  double number(double deviation);

 private:
  std::uint64_t state_;
};

}  // namespace tumble::test
