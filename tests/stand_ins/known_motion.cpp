// SPDX-License-Identifier: BSD-3-Clause
#include "stand_ins/known_motion.hpp"

#include <algorithm>

#include "tumble/common/types.hpp"

namespace tumble::test {

namespace {

constexpr double kStep_s = 2e-4;

}  // namespace

Eigen::Vector3d angular_velocity(const KnownMotion& motion, double t) {
  return so3::logarithm(motion.q_WI(t - kStep_s).conjugate() * motion.q_WI(t + kStep_s)) / (2.0 * kStep_s);
}

Eigen::Vector3d specific_force(const KnownMotion& motion, double t) {
  const Eigen::Vector3d acceleration =
      (motion.p_WI_m(t - kStep_s) - 2.0 * motion.p_WI_m(t) + motion.p_WI_m(t + kStep_s)) / (kStep_s * kStep_s);
  return motion.q_WI(t).conjugate() * (acceleration + Eigen::Vector3d(0.0, 0.0, kStandardGravity_m_s2));
}

double smooth_step(double t, double begin, double length) {
  const double u = std::clamp((t - begin) / length, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

double window(double t, double begin, double end, double ramp) {
  return smooth_step(t, begin, ramp) * (1.0 - smooth_step(t, end - ramp, ramp));
}

double Noise::number(double deviation) {
  double sum = -6.0;  // sum of twelve uniform numbers: variance one
  for (int k = 0; k < 12; ++k) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    sum += static_cast<double>(state_ >> 11) * 0x1.0p-53;
  }
  return deviation * sum;
}

Eigen::Vector3d Noise::vector(double deviation) {
  const double x = number(deviation), y = number(deviation), z = number(deviation);
  return {x, y, z};
}

}  // namespace tumble::test
