// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tumble::sim {
namespace {

/// Mean power per wave number [m^2 per rad/m, arbitrary scale] of sections along x, over many reliefs, at `k_rad_m`:
/// Fourier transform of a section of 60 m with a Hann window.
double cut_power(const ReliefSpectrum& spectrum, double k_rad_m) {
  constexpr int kReliefs = 300, kSamples = 600;
  constexpr double kStep_m = 0.1;
  double power = 0.0;
  for (int i = 0; i < kReliefs; ++i) {
    Stream stream(static_cast<std::uint64_t>(i), "test");
    const Relief relief(stream, spectrum);
    std::complex<double> sum = 0.0;
    for (int n = 0; n < kSamples; ++n) {
      const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * n / kSamples);
      sum += window * relief.height_m(n * kStep_m, 3.0) * std::polar(1.0, -k_rad_m * n * kStep_m);
    }
    power += std::norm(sum);
  }
  return power;
}

/// Returns the exponent of the power's decrease between wavelengths of 6 and 2 m.
double measured_exponent(const ReliefSpectrum& spectrum) {
  const double low = 2.0 * std::numbers::pi / 6.0, high = 2.0 * std::numbers::pi / 2.0;
  return -std::log(cut_power(spectrum, high) / cut_power(spectrum, low)) / std::log(high / low);
}

TEST(Relief, PowerFallsOffWithTheStatedExponent) {
  for (const double exponent : {1.0, 2.0, 3.0}) {
    // long waves exceed both ends, so neither end bends the line; for a ruled relief, a section along x has every wave
    // at its own wave number. 300 reliefs of 32 waves have a scatter of about 0.15 (measured errors: 0.02 to 0.12)
    const ReliefSpectrum spectrum{0.2, 0.5, 20.0, exponent, true};
    EXPECT_NEAR(measured_exponent(spectrum), exponent, 0.35) << "ruled";
  }
  // for waves in all directions, a section has smaller wave numbers, but a power law keeps its exponent
  EXPECT_NEAR(measured_exponent({0.2, 0.25, 20.0, 3.0, false}), 3.0, 0.4);
}

TEST(Relief, HasTheStatedHeightAndNoPowerOutsideOfItsBand) {
  const ReliefSpectrum spectrum{0.15, 1.0, 4.0, 2.0, false};
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Stream stream(seed, "test");
    const Relief relief(stream, spectrum);
    for (int i = 0; i < 100; ++i, ++count) {
      const double h = relief.height_m(1.7 * i, -2.3 * i);
      sum += h * h;
    }
  }
  EXPECT_NEAR(std::sqrt(sum / count), 0.15, 0.005);  // 60 reliefs of 32 waves: 1.5 % of scatter
  const double inside = cut_power({0.15, 1.0, 4.0, 2.0, true}, 2.0 * std::numbers::pi / 2.0);
  const double longer = cut_power({0.15, 1.0, 4.0, 2.0, true}, 2.0 * std::numbers::pi / 10.0);
  EXPECT_LT(longer, 1e-3 * inside);
}

TEST(Relief, RuledMeansThatContourLinesAreStraight) {
  Stream one(7, "test"), two(7, "test");
  const Relief ruled(one, {0.2, 1.0, 9.0, 3.0, true}), other(two, {0.2, 1.0, 9.0, 3.0, false});
  double largest = 0.0;
  for (int i = 0; i < 50; ++i) {
    EXPECT_NEAR(ruled.height_m(0.3 * i, 5.0), ruled.height_m(0.3 * i, -11.0), 1e-12);
    largest = std::max(largest, std::abs(other.height_m(0.3 * i, 5.0) - other.height_m(0.3 * i, -11.0)));
  }
  EXPECT_GT(largest, 0.05);
}

TEST(Relief, BelongsToTheStream) {
  Stream a(7, "test"), b(7, "test"), c(8, "test");
  const ReliefSpectrum spectrum;
  const Relief first(a, spectrum), again(b, spectrum), other(c, spectrum);
  EXPECT_EQ(first.height_m(1.0, 2.0), again.height_m(1.0, 2.0));
  EXPECT_NE(first.height_m(1.0, 2.0), other.height_m(1.0, 2.0));
}

TEST(Bumps, AreOfTheStatedHeightAndDeterministic) {
  Ground one(201, 10.0), again(201, 10.0), single(201, 10.0);
  Stream a(3, "test"), b(3, "test"), c(4, "test");
  add_bumps(one, a, 80, 0.2);
  add_bumps(again, b, 80, 0.2);
  add_bumps(single, c, 1, 0.2);
  double rough = 0.0, highest = 0.0;
  for (int row = 0; row < 201; ++row) {
    for (int column = 0; column < 201; ++column) {
      ASSERT_EQ(one.node_m(row, column), again.node_m(row, column));
      rough += std::abs(one.node_m(row, column));
      highest = std::max(highest, std::abs(single.node_m(row, column)));
    }
  }
  EXPECT_GT(rough, 0.0);
  EXPECT_GT(highest, 0.0);
  EXPECT_LE(highest, 0.2);
}

}  // namespace
}  // namespace tumble::sim
