// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/stages.hpp"

#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns the amplitude of the low-pass's response to a sine, after its transient.
double gain(double cutoff_hz, double tone_hz) {
  constexpr double kRate_hz = 2000.0;
  LowPass low_pass(cutoff_hz, kRate_hz);
  double in_phase = 0.0, quadrature = 0.0;
  constexpr int kFirst = 2000, kCount = 2000;  // one second, which contains whole periods for integer frequencies
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
  // the filter is a bilinear transform with the cutoff prewarped: |H|^2 = 1 / (1 + (tan(pi f / fs) / tan(pi fc /
  // fs))^4)
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
    const Matrix3d errors = draw_axis_errors(stream, 0.003, 0.01) - Eigen::Matrix3d::Identity();
    scale += errors.diagonal().squaredNorm();
    angle += errors.squaredNorm() - errors.diagonal().squaredNorm();
  }
  // for 12000 and 24000 numbers, 5 standard errors of a standard deviation are 5/sqrt(2n), 3.2 % and 2.3 %; the
  // false-alarm probability is 6e-7
  EXPECT_NEAR(std::sqrt(scale / (3 * kDraws)), 0.003, 0.032 * 0.003);
  EXPECT_NEAR(std::sqrt(angle / (6 * kDraws)), 0.01, 0.023 * 0.01);
}

TEST(NoiseStage, HasItsDensity) {
  Stream stream(1, "test");
  double sum = 0.0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) sum += white_noise(stream, Vector3d::Constant(0.01), 2000.0).squaredNorm();
  const double variance = 0.01 * 0.01 * 2000.0, n = 3.0 * kDraws;
  EXPECT_NEAR(sum / n, variance, 5.0 * std::sqrt(2.0 / n) * variance);  // false alarm 6e-7
  EXPECT_EQ(white_noise(stream, Vector3d::Zero(), 2000.0), Vector3d::Zero());
}

TEST(NoiseStage, OffDrawsNothing) {
  Stream used(1, "test"), fresh(1, "test");
  white_noise(used, Vector3d::Zero(), 2000.0);
  normals(used, 0.0);
  EXPECT_EQ(used.normal(), fresh.normal());
}

TEST(NoiseStage, EachAxisHasItsOwnDensityOfOneRealisation) {
  Stream a(1, "test"), b(1, "test");
  const Vector3d coarse = white_noise(a, Vector3d::Constant(0.6), 100.0);
  const Vector3d mixed = white_noise(b, Vector3d(0.6, 0.06, 0.6), 100.0);
  EXPECT_EQ(mixed.x(), coarse.x());
  EXPECT_NEAR(mixed.y(), 0.1 * coarse.y(), 1e-15);
}

TEST(RangeStage, ChangesEachAxisWithHysteresis) {
  RangeChoice range(2.0);
  const auto after = [&](const Vector3d& signal) {
    range.update(signal);
    return range.pick(1.0, 0.1);
  };
  EXPECT_EQ(after({1.0, 3.0, -2.5}), Vector3d(0.1, 1.0, 1.0));
  EXPECT_EQ(after({1.95, 1.95, -1.7}), Vector3d(0.1, 1.0, 0.1));  // y: not yet below 1.8, but z is
  EXPECT_EQ(after({-2.01, 1.79, -1.95}), Vector3d(1.0, 0.1, 0.1));
}

TEST(RangeStage, OffIsTheCoarsePartAlways) {
  RangeChoice range(0.0);
  range.update(Vector3d::Zero());
  EXPECT_EQ(range.pick(1.0, 0.1), Vector3d(1.0, 1.0, 1.0));
}

TEST(DelayStage, OffReturnsTheInputBitForBit) {
  DelayLine off(0.0, 2000.0);
  const Vector3d input(0.1, 1.0 / 3.0, -1e9);
  EXPECT_EQ(off(input), input);
  EXPECT_EQ(off(-input), -input);
}

TEST(DelayStage, WholeSamplesComeLateUnchanged) {
  DelayLine delay(0.0015, 2000.0);  // three samples
  for (int k = 0; k < 20; ++k) ASSERT_EQ(delay(Vector3d(k, -k, 1.0)).x(), std::max(0, k - 3)) << k;
}

TEST(DelayStage, PartsOfASampleAreInterpolatedAndNothingIsLost) {
  DelayLine delay(0.0026, 1000.0);
  double area = 0.0, moment = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double out = delay(Vector3d(k == 10 ? 300.0 : 0.0, 0, 0)).x();
    area += out;
    moment += k * out;
  }
  EXPECT_NEAR(area, 300.0, 1e-10);
  EXPECT_NEAR(moment / area, 12.6, 1e-10);
}

TEST(QuantumStage, RoundsToMultiples) {
  EXPECT_TRUE(quantise({0.26, -0.26, 0.24}, Vector3d::Constant(0.5)).isApprox(Vector3d(0.5, -0.5, 0.0), 1e-15));
  EXPECT_TRUE(quantise({0.26, 0.26, 0.26}, {0.5, 0.0, 0.1}).isApprox(Vector3d(0.5, 0.26, 0.3), 1e-15));
  const Vector3d input(0.1, 1.0 / 3.0, -7.0);
  EXPECT_EQ(quantise(input, Vector3d::Zero()), input);
}

}  // namespace
}  // namespace tumble::sim
