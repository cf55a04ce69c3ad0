// SPDX-License-Identifier: BSD-3-Clause
// The test compares sensing elements that have their own axes with the closed form of elements.hpp.
#include "sim/imu/elements.hpp"

#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kRail = 10.27;

Rail clamp(double level = kRail) {
  return {{.level = level}, 0.0005, Stream(1, "test")};
}

/// Returns tilts of 2 to 5 %, as measured at the pendulum's saturation level, and scales of 1 to 3 %.
Matrix3d tilted() {
  Matrix3d axes;
  axes << 1.01, 0.03, -0.05, -0.04, 0.97, 0.02, 0.05, -0.01, 1.03;
  return axes;
}

Vector3d clip(const Elements& elements, const Vector3d& signal, std::uint8_t* flags = nullptr) {
  Rail rail = clamp();
  std::uint8_t own = 0;
  return elements.clip(signal, rail, 0, flags == nullptr ? own : *flags);
}

Vector3d any_signal(Stream& stream, double size) {
  return {stream.uniform(-size, size), stream.uniform(-size, size), stream.uniform(-size, size)};
}

TEST(Elements, UprightAreTheRailAloneBitForBit) {
  const Elements none, drawn({}, Stream(1, "test")), given(Matrix3d::Identity(), Vector3d::Zero());
  Stream stream(1, "signal");
  for (const Elements* each : {&none, &drawn, &given}) {
    ASSERT_TRUE(each->axis_aligned());
    for (const Rail::Params& kind :
         {Rail::Params{.level = kRail}, Rail::Params{.level = kRail, .axis_spread = 0.2, .event_spread = 0.1},
          Rail::Params{.level = kRail, .wrap = true},
          Rail::Params{.level = kRail, .recovery_s = 0.05, .recovery_share = 0.2}}) {
      Rail alone(kind, 0.0005, Stream(1, "rail")), behind(kind, 0.0005, Stream(1, "rail"));
      for (int k = 0; k < 200; ++k) {
        const Vector3d signal = any_signal(stream, 15.0);
        std::uint8_t own = 0, flags = 0;
        ASSERT_EQ(each->clip(signal, behind, 0, flags), alone(signal, 0, own));
        ASSERT_EQ(flags, own);
      }
    }
  }
}

TEST(Elements, WithinTheirRailsTheyCannotBeSeen) {
  const Elements elements(tilted(), {0.05, -0.1, 0.02});
  ASSERT_FALSE(elements.axis_aligned());
  Stream stream(1, "signal");
  for (int k = 0; k < 1000; ++k) {
    const Vector3d signal = any_signal(stream, 9.0);
    std::uint8_t flags = 0;
    ASSERT_EQ(clip(elements, signal, &flags), signal);
    ASSERT_EQ(flags, 0);
  }
}

TEST(Elements, OneAtItsRailReadsAPlaneAndMovesTheAxesBeside) {
  const Elements elements(tilted(), Vector3d::Zero());
  const Matrix3d inverse = tilted().inverse();
  Stream stream(1, "signal");
  for (int k = 0; k < 1000; ++k) {
    Vector3d signal = any_signal(stream, 7.0);
    signal.z() = std::copysign(13.0 + k % 5, signal.z());
    const double rail = std::copysign(kRail, signal.z());
    std::uint8_t flags = 0;
    const Vector3d reading = clip(elements, signal, &flags);
    ASSERT_EQ(flags, 0b100);
    // the saturation plane in full is z = (r - m_x x - m_y y) / m_z
    ASSERT_NEAR(reading.z(), (rail - 0.05 * reading.x() + 0.01 * reading.y()) / 1.03, 1e-12);
    const double deficit = 0.05 * signal.x() - 0.01 * signal.y() + 1.03 * signal.z() - rail;
    ASSERT_NEAR(reading.x(), signal.x() - inverse(0, 2) * deficit, 1e-12);
    ASSERT_NEAR(reading.y(), signal.y() - inverse(1, 2) * deficit, 1e-12);
    // the readings of unsaturated elements are right nevertheless
    ASSERT_NEAR(1.01 * reading.x() + 0.03 * reading.y() - 0.05 * reading.z(),
                1.01 * signal.x() + 0.03 * signal.y() - 0.05 * signal.z(), 1e-12);
    // 5 % of at least 2 rad/s, which is a large effect
    ASSERT_GT(std::abs(reading.x() - signal.x()), 0.05 * 2.0 * 0.9);
  }
}

TEST(Elements, TwoAtTheirRailsLeaveOneTruthAndThreeNone) {
  const Elements elements(tilted(), Vector3d::Zero());
  std::uint8_t flags = 0;
  const Vector3d two = clip(elements, {14.0, -3.0, -15.0}, &flags);
  EXPECT_EQ(flags, 0b101);
  EXPECT_NEAR(tilted().row(0).dot(two), kRail, 1e-12);
  EXPECT_NEAR(tilted().row(1).dot(two), tilted().row(1).dot(Vector3d(14.0, -3.0, -15.0)), 1e-12);
  EXPECT_NEAR(tilted().row(2).dot(two), -kRail, 1e-12);
  flags = 0;
  const Vector3d three = clip(elements, {14.0, -13.0, 15.0}, &flags), others = clip(elements, {20.0, -25.0, 13.0});
  EXPECT_EQ(flags, 0b111);
  EXPECT_NEAR((three - others).norm(), 0.0, 1e-12);  // only the signs remain
  EXPECT_NEAR((tilted() * three - Vector3d(kRail, -kRail, kRail)).norm(), 0.0, 1e-12);
}

TEST(Elements, OffsetSetsTheSignsApart) {
  // the wand has r = 7.30 rad/s and saturation levels of x at +7.25 and -7.35
  const Elements elements(Matrix3d::Identity(), {0.05, 0.0, 0.0});
  Rail rail = clamp(7.30);
  std::uint8_t flags = 0;
  EXPECT_NEAR((elements.clip({10.0, 3.0, 1.0}, rail, 0, flags) - Vector3d(7.25, 3.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((elements.clip({-10.0, 3.0, 1.0}, rail, 0, flags) - Vector3d(-7.35, 3.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(elements.clip({7.24, -7.29, 7.29}, rail, 0, flags), Vector3d(7.24, -7.29, 7.29));
  EXPECT_EQ(elements.clip({-7.34, 7.29, 0.0}, rail, 0, flags), Vector3d(-7.34, 7.29, 0.0));
}

TEST(Elements, TheFlagIsThatOfTheElementAndNotOfTheAxis) {
  // 10.3 about x is beyond the saturation level of an upright element; this element, which measures 0.97 of it, is not
  // saturated
  Matrix3d axes = Matrix3d::Identity();
  axes(0, 0) = 0.97;
  std::uint8_t flags = 0;
  EXPECT_EQ(clip({axes, Vector3d::Zero()}, {10.3, 0.0, 0.0}, &flags), Vector3d(10.3, 0.0, 0.0));
  EXPECT_EQ(flags, 0);
  axes(0, 0) = 1.0;
  axes(0, 1) = 0.05;  // 10.1 does not, but the element also senses 5 % of 9 about y
  clip({axes, Vector3d::Zero()}, {10.1, 9.0, 0.0}, &flags);
  EXPECT_EQ(flags, 0b001);
}

TEST(Elements, SomeMayBeTakenFromAnotherReading) {
  const Elements elements(tilted(), Vector3d::Zero());
  const Vector3d a(1.0, 2.0, 3.0), b(1.5, -2.0, 3.25), mixed = elements.with_elements_of(b, 0b010, a);
  EXPECT_NEAR(tilted().row(0).dot(mixed), tilted().row(0).dot(a), 1e-12);
  EXPECT_NEAR(tilted().row(1).dot(mixed), tilted().row(1).dot(b), 1e-12);
  EXPECT_NEAR(tilted().row(2).dot(mixed), tilted().row(2).dot(a), 1e-12);
  EXPECT_EQ(elements.with_elements_of(b, 0, a), a);
  EXPECT_EQ(Elements().with_elements_of(b, 0b010, a), Vector3d(1.0, -2.0, 3.0));
}

TEST(Elements, AreDrawnAsStated) {
  const Elements::Params params{.misalignment = 0.02, .scale = 0.01, .offset = 0.05};
  Matrix3d squares = Matrix3d::Zero();
  Vector3d offsets = Vector3d::Zero();
  constexpr int kDevices = 2000;
  for (int device = 0; device < kDevices; ++device) {
    const Elements drawn(params, Stream(static_cast<std::uint64_t>(device), "imu.gyro.elements"));
    const Matrix3d errors = drawn.axes() - Matrix3d::Identity();
    ASSERT_LE(errors.cwiseAbs().maxCoeff(), 0.06 + 1e-12);  // limited to three standard deviations
    squares += errors.cwiseAbs2();
    offsets += drawn.offset().cwiseAbs2();
  }
  // the tolerance is 5 standard errors: 5 / sqrt(2 * 2000) = 8 %; the cut at three standard deviations reduces the
  // deviation by 1.3 %
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(std::sqrt(squares(row, column) / kDevices), row == column ? 0.01 : 0.02, 0.09 * 0.02);
    }
    EXPECT_NEAR(std::sqrt(offsets[row] / kDevices), 0.05, 0.09 * 0.05);
  }
  const Elements one(params, Stream(1, "a")), again(params, Stream(1, "a")), other(params, Stream(1, "b"));
  EXPECT_EQ(one.axes(), again.axes());
  EXPECT_EQ(one.offset(), again.offset());
  EXPECT_NE(one.axes(), other.axes());
  EXPECT_FALSE(Elements({.offset = 0.05}, Stream(1, "a")).axis_aligned());
}

TEST(Elements, WhateverIsDrawnCanBeUndone) {
  // the worst allowed matrix has every entry at three standard deviations, with the harmful sign
  const double most = 3.0 * Elements::kMisalignmentMax;
  Matrix3d worst = Matrix3d::Constant(most);
  worst.diagonal().setConstant(1.0 - most);
  const Elements elements(worst, Vector3d::Zero());
  const Vector3d reading = clip(elements, {40.0, 1.0, -2.0});
  EXPECT_TRUE(reading.allFinite());
  EXPECT_NEAR(worst.row(0).dot(reading), kRail, 1e-10);
}

}  // namespace
}  // namespace tumble::sim
