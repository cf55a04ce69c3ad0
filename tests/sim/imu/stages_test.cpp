// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/stages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tumble::sim {
namespace {

using Eigen::Vector3d;

/// Amplitude of the low-pass's answer to a sine, after its transient.
double gain(double cutoff_hz, double tone_hz) {
  constexpr double kRate_hz = 2000.0;
  LowPass low_pass(cutoff_hz, kRate_hz);
  double in_phase = 0.0, quadrature = 0.0;
  constexpr int kFirst = 2000, kCount = 2000;  // one second: whole periods of whole-number tones
  for (int k = 0; k < kFirst + kCount; ++k) {
    const double phase = 2.0 * std::numbers::pi * tone_hz * k / kRate_hz;
    const double y = low_pass(Vector3d(std::sin(phase), 0, 0)).x();
    if (k < kFirst) continue;
    in_phase += 2.0 / kCount * y * std::sin(phase);
    quadrature += 2.0 / kCount * y * std::cos(phase);
  }
  return std::hypot(in_phase, quadrature);
}

TEST(LowPassStage, OffReturnsTheInputBitForBit) {
  LowPass off(0.0, 2000.0);
  const Vector3d input(0.1, -1e9, 1.0 / 3.0);
  EXPECT_EQ(off(input), input);
  EXPECT_EQ(off(-input), -input);
}

TEST(LowPassStage, HasTheGainOfASecondOrderButterworth) {
  // bilinear transform with the cutoff prewarped: |H|^2 = 1 / (1 + (tan(pi f / fs) / tan(pi fc / fs))^4)
  for (const double tone_hz : {10.0, 100.0, 415.0, 700.0}) {
    const double ratio = std::tan(std::numbers::pi * tone_hz / 2000.0) / std::tan(std::numbers::pi * 415.0 / 2000.0);
    EXPECT_NEAR(gain(415.0, tone_hz), 1.0 / std::sqrt(1.0 + std::pow(ratio, 4)), 1e-9) << tone_hz << " Hz";
  }
}

TEST(LowPassStage, StartsInItsSteadyState) {
  LowPass low_pass(100.0, 2000.0);
  for (int k = 0; k < 100; ++k) ASSERT_NEAR(low_pass(Vector3d(1, 2, -9.8)).z(), -9.8, 1e-12);
}

TEST(LowPassStage, PassesTheWholeAreaOfAnImpact) {
  LowPass low_pass(100.0, 2000.0);
  low_pass(Vector3d::Zero());
  double area = 0.0;
  for (int k = 0; k < 400; ++k) area += low_pass(Vector3d(k == 0 ? 300.0 : 0.0, 0, 0)).x();
  EXPECT_NEAR(area, 300.0, 1e-9);
}

TEST(AxisErrorStage, OffIsExactlyTheIdentity) {
  Stream stream(1, "test");
  EXPECT_EQ(draw_axis_errors(stream, 0.0, 0.0), Eigen::Matrix3d::Identity());
}

TEST(AxisErrorStage, DrawsScaleOnTheDiagonalAndAnglesBesideIt) {
  double scale = 0.0, angle = 0.0;
  constexpr int kDraws = 4000;
  Stream stream(1, "test");
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Matrix3d errors = draw_axis_errors(stream, 0.003, 0.01) - Eigen::Matrix3d::Identity();
    scale += errors.diagonal().squaredNorm();
    angle += errors.squaredNorm() - errors.diagonal().squaredNorm();
  }
  // 12000 and 24000 numbers: 5 standard errors of a standard deviation are 5/sqrt(2n), 3.2 % and 2.3 %; false alarm
  // 6e-7
  EXPECT_NEAR(std::sqrt(scale / (3 * kDraws)), 0.003, 0.032 * 0.003);
  EXPECT_NEAR(std::sqrt(angle / (6 * kDraws)), 0.01, 0.023 * 0.01);
}

TEST(BiasStage, OffIsExactlyZero) {
  Stream stream(1, "test");
  Bias bias({}, 0.0005, stream);
  for (int k = 0; k < 10; ++k) ASSERT_EQ(bias.next(stream), Vector3d::Zero());
}

TEST(BiasStage, TurnOnIsDrawnOnceWithItsSigma) {
  double sum = 0.0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    Stream stream(i, "test");
    Bias bias({.turn_on = 0.2}, 0.0005, stream);
    const Vector3d first = bias.next(stream);
    ASSERT_EQ(bias.next(stream), first);
    sum += first.squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / (3 * kDraws)), 0.2, 0.032 * 0.2);  // 5 standard errors, false alarm 6e-7
}

TEST(BiasStage, InRunIsStationaryAndDecaysWithItsTime) {
  constexpr double kPeriod_s = 0.01;
  constexpr int kRuns = 2000, kLater = 100;  // 1 s, the correlation time
  double start = 0.0, later = 0.0, product = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Stream stream(run, "test");
    Bias bias({.in_run = 1.0, .in_run_s = 1.0}, kPeriod_s, stream);
    const Vector3d first = bias.next(stream);
    Vector3d last = first;
    for (int k = 0; k < kLater; ++k) last = bias.next(stream);
    start += first.squaredNorm();
    later += last.squaredNorm();
    product += first.dot(last);
  }
  const double n = 3.0 * kRuns;
  EXPECT_NEAR(start / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(later / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(product / n, std::exp(-1.0), 5.0 * std::sqrt((1.0 + std::exp(-2.0)) / n));  // false alarm 6e-7 each
}

TEST(BiasStage, WalkGrowsWithTheRootOfTimeWhateverThePeriod) {
  for (const double period_s : {0.0005, 0.01}) {
    double sum = 0.0;
    constexpr int kRuns = 500;
    for (int run = 0; run < kRuns; ++run) {
      Stream stream(run, "test");
      Bias bias({.walk_sqrt_s = 0.1}, period_s, stream);
      Vector3d last = Vector3d::Zero();
      for (int k = 0; k <= std::lround(0.25 / period_s); ++k) last = bias.next(stream);
      sum += last.squaredNorm();
    }
    const double n = 3.0 * kRuns;
    EXPECT_NEAR(sum / n, 0.25 * 0.01, 5.0 * std::sqrt(2.0 / n) * 0.25 * 0.01)
        << "period " << period_s;  // false alarm 6e-7
  }
}

TEST(NoiseStage, HasItsDensity) {
  Stream stream(1, "test");
  double sum = 0.0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) sum += white_noise(stream, 0.01, 2000.0).squaredNorm();
  const double variance = 0.01 * 0.01 * 2000.0, n = 3.0 * kDraws;
  EXPECT_NEAR(sum / n, variance, 5.0 * std::sqrt(2.0 / n) * variance);  // false alarm 6e-7
  EXPECT_EQ(white_noise(stream, 0.0, 2000.0), Vector3d::Zero());
}

TEST(RailStage, ClampsEachAxisAndFlagsIt) {
  std::uint8_t flags = 0;
  EXPECT_EQ(apply_rail({11.0, -10.6, 10.5}, 10.5, 3, flags), Vector3d(10.5, -10.5, 10.5));
  EXPECT_EQ(flags, 0b011000);  // exactly at the rail is not beyond it
}

TEST(RailStage, OffPassesEverything) {
  std::uint8_t flags = 0;
  EXPECT_EQ(apply_rail({1e6, -1e6, 0}, 0.0, 0, flags), Vector3d(1e6, -1e6, 0));
  EXPECT_EQ(flags, 0);
}

TEST(QuantumStage, RoundsToMultiples) {
  EXPECT_TRUE(quantise({0.26, -0.26, 0.24}, 0.5).isApprox(Vector3d(0.5, -0.5, 0.0), 1e-15));
  const Vector3d input(0.1, 1.0 / 3.0, -7.0);
  EXPECT_EQ(quantise(input, 0.0), input);
}

}  // namespace
}  // namespace tumble::sim
