// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_merge_state.hpp"

#include "tests/testing.hpp"

// tests which axis labels the force differences of a rigid body support
namespace tumble {
namespace {

using TurnedReading = std::function<void(Eigen::Vector3d& rate, Eigen::Vector3d& acceleration, Eigen::Vector3d& force)>;

/// Returns the result for ten seconds of a body that turns about all axes, `size` times as fast, with noise and bias of
/// a cheap accelerometer.
MultiImuSignCheck senses_of(double size, const TurnedReading& misread) {
  MultiImuSignCheck out;
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

TEST(MultiImuSignCheck, ACorrectReadingIsNotReported) {
  const auto as_it_is = [](auto&, auto&, auto&) {};
  const MultiImuSignCheck out = senses_of(1.0, as_it_is);
  EXPECT_FALSE(out.detected_mirroring().has_value());
  for (std::size_t k = 0; k < MultiImuSignCheck::kMirroredAlternatives; ++k) {
    ASSERT_GT(out.effect_per_alternative[k], MultiImuSignCheck::kMinEffectOnForces) << k;
    EXPECT_NEAR(out.explained_effect_per_alternative[k] / out.effect_per_alternative[k], -1.0, 0.5) << k;
  }
  EXPECT_FALSE(MultiImuSignCheck{}.detected_mirroring().has_value());
}

TEST(MultiImuSignCheck, EachIsReportedWithItsSensor) {
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
      const auto told = senses_of(1.0, all[k]).detected_mirroring();
      ASSERT_TRUE(told.has_value()) << axis << " " << k;
      EXPECT_EQ(told->mirroring, 3 * k + static_cast<std::size_t>(axis));
      EXPECT_NEAR(told->explained_fraction, 1.0, 0.5);
    }
  }
}

TEST(MultiImuSignCheck, ABodyThatHardlyRotatesIndicatesNothing) {
  EXPECT_FALSE(senses_of(0.05, [](auto& w, auto& a, auto&) { w.x() = -w.x(), a.x() = -a.x(); })
                   .detected_mirroring()
                   .has_value());
}

}  // namespace
}  // namespace tumble
