// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/unit_sign_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

// tests the axis signs of IMUs that the force differences of a rigid body determine
namespace tumble {
namespace {

using TurnedReading = std::function<void(Eigen::Vector3d& rate, Eigen::Vector3d& acceleration, Eigen::Vector3d& force)>;

/// Ten seconds of a body that rotates about all axes, `size` times as fast, with noise and bias of a low-cost
/// accelerometer.
UnitSignCheck senses_of(double size, const TurnedReading& misread) {
  UnitSignCheck out;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.03);
  for (int k = 0; k < 2500; ++k) {
    const double t = 0.004 * k;
    const Eigen::Vector3d w =
        size * Eigen::Vector3d(3.0 * std::sin(t), 4.0 * std::cos(0.7 * t), 2.5 * std::sin(1.3 * t + 1.0));
    const Eigen::Vector3d a =
        size * Eigen::Vector3d(3.0 * std::cos(t), -2.8 * std::sin(0.7 * t), 3.25 * std::cos(1.3 * t + 1.0));
    for (const Eigen::Vector3d& d : {Eigen::Vector3d(0.08, 0.0, 0.01), Eigen::Vector3d(-0.08, 0.0, -0.01)}) {
      Eigen::Vector3d rate = w, acceleration = a;
      Eigen::Vector3d force = a.cross(d) + w.cross(w.cross(d)) + d.x() * Eigen::Vector3d(1.0, -1.0, 0.5);
      for (double& f : force) f += noise(random);
      misread(rate, acceleration, force);
      out.add(force, d, rate, acceleration, 0.004);
    }
  }
  return out;
}

TEST(UnitSignCheck, WhatIsReadAsItIsIsNotTold) {
  const auto as_it_is = [](auto&, auto&, auto&) {};
  const UnitSignCheck out = senses_of(1.0, as_it_is);
  EXPECT_FALSE(out.detected().has_value());
  for (std::size_t k = 0; k < UnitSignCheck::kAlternatives; ++k) {
    ASSERT_GT(out.effect_m2_s3[k], UnitSignCheck::kEffectMin_m2_s3) << k;
    EXPECT_NEAR(out.explained_m2_s3[k] / out.effect_m2_s3[k], -1.0, 0.5) << k;
  }
  EXPECT_FALSE(UnitSignCheck{}.detected().has_value());
}

TEST(UnitSignCheck, EachIsToldByItsPlace) {
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3;
    const auto gyro_flipped = [=](auto& w, auto& a, auto&) { w[axis] = -w[axis], a[axis] = -a[axis]; };
    const auto gyro_swapped = [=](auto& w, auto& a, auto&) {
      std::swap(w[axis], w[next]), std::swap(a[axis], a[next]);
    };
    const auto accel_flipped = [=](auto&, auto&, auto& f) { f[axis] = -f[axis]; };
    const auto accel_swapped = [=](auto&, auto&, auto& f) { std::swap(f[axis], f[next]); };
    const std::array<TurnedReading, 4> all = {gyro_flipped, gyro_swapped, accel_flipped, accel_swapped};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto told = senses_of(1.0, all[k]).detected();
      ASSERT_TRUE(told.has_value()) << axis << " " << k;
      EXPECT_EQ(told->sense, 3 * k + static_cast<std::size_t>(axis));
      EXPECT_NEAR(told->share, 1.0, 0.5);
    }
  }
}

TEST(UnitSignCheck, ABodyThatHardlyTurnsTellsNothing) {
  EXPECT_FALSE(senses_of(0.05, [](auto& w, auto& a, auto&) { w.x() = -w.x(), a.x() = -a.x(); }).detected().has_value());
}

}  // namespace
}  // namespace tumble
