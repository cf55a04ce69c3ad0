// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::testing {

/// RollingTruth is a sphere with a prescribed motion over a plane, and the exact readings of an ideal IMU inside.
struct RollingTruth {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;
  std::vector<Eigen::Vector3d> p_WG_m;
  std::vector<bool> gripping;  ///< contact velocity below 1 mm/s
};

inline const Eigen::Vector3d kLeverArm(0.02, -0.01, 0.03);  ///< position of the IMU in tests with an off-centre IMU
inline constexpr double kRadius_m = 0.145;                  ///< default radius of the spheres in these tests

struct RollingMotion {
  std::function<Eigen::Vector3d(double)> velocity_m_s;          ///< velocity of the centre, horizontal
  std::function<Eigen::Vector3d(double)> contact_velocity_m_s;  ///< of the contact point; zero with grip
  double duration_s = 10.0;
  double radius_m = kRadius_m;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes
  Eigen::Quaterniond q_start = Eigen::Quaterniond::Identity();
  TimeNs period_ns = 4'000'000;
  double gravity_m_s2 = 9.80665;
};

inline RollingTruth roll(const RollingMotion& motion) {
  constexpr int kSubsteps = 16;
  const double h = seconds(motion.period_ns) / kSubsteps;
  const auto rate_W = [&motion](double t) -> Eigen::Vector3d {  // v - u = r w x n
    return Eigen::Vector3d::UnitZ().cross(motion.velocity_m_s(t) - motion.contact_velocity_m_s(t)) / motion.radius_m;
  };
  RollingTruth truth;
  Eigen::Quaterniond q = motion.q_start;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  const auto imu_velocity = [&](double t, const Eigen::Quaterniond& at) -> Eigen::Vector3d {
    return motion.velocity_m_s(t) + rate_W(t).cross(at * motion.lever_arm_m);
  };
  const int count = static_cast<int>(motion.duration_s / seconds(motion.period_ns));
  for (int k = 0; k <= count; ++k) {
    Eigen::Vector3d turned = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
    for (int j = 0; j < kSubsteps; ++j) {
      const double t = ((k - 1) * kSubsteps + j) * h;
      const Eigen::Vector3d step = h * rate_W(t + 0.5 * h);
      const Eigen::Quaterniond q_next = (so3::exp(step) * q).normalized();
      const Eigen::Quaterniond q_mid = so3::exp(0.5 * step) * q;
      const Eigen::Vector3d gained = imu_velocity(t + h, q_next) - imu_velocity(t, q);
      force += q_mid.conjugate() * (gained + h * motion.gravity_m_s2 * Eigen::Vector3d::UnitZ());
      turned += q_mid.conjugate() * step;
      p += h / 6.0 * (motion.velocity_m_s(t) + 4.0 * motion.velocity_m_s(t + 0.5 * h) + motion.velocity_m_s(t + h));
      q = q_next;
    }
    const double t = k * seconds(motion.period_ns);
    const double period = seconds(motion.period_ns);
    truth.samples.push_back({k * motion.period_ns, turned / period, force / period, 0});
    truth.q_WI.push_back(q);
    truth.p_WG_m.push_back(p);
    truth.gripping.push_back(motion.contact_velocity_m_s(t).norm() < 1e-3);
  }
  return truth;
}

/// Returns the speed of a move of `length` from rest to rest over [start, start + duration]: the minimum-jerk profile.
inline double minimum_jerk_speed(double t, double start_s, double duration_s, double length_m) {
  const double x = std::clamp((t - start_s) / duration_s, 0.0, 1.0);
  return length_m / duration_s * 30.0 * x * x * (1.0 - x) * (1.0 - x);
}

/// One metre along x, then one metre along y, each in 2.5 s, with rests of 2 s at both ends; 10 s in total.
inline Eigen::Vector3d l_shape(double t) {
  return {minimum_jerk_speed(t, 2.0, 2.5, 1.0), minimum_jerk_speed(t, 5.5, 2.5, 1.0), 0.0};
}

inline Eigen::Vector3d no_slip(double) {
  return Eigen::Vector3d::Zero();
}

}  // namespace tumble::testing
