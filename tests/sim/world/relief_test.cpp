// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/relief.hpp"

#include <complex>

#include "sim/world/terrain/ground.hpp"
#include "sim/world/terrain/profile.hpp"
#include "sim/world/terrain/stairs.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns the mean power per wave number [m^2 per rad/m, arbitrary scale] of cuts along x, over many reliefs, at
/// `k_rad_m`, from the Fourier transform of a cut of 60 m under a Hann window.
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

/// Returns the exponent with which the power falls between wavelengths of 6 and 2 m.
double measured_exponent(const ReliefSpectrum& spectrum) {
  const double low = 2.0 * std::numbers::pi / 6.0, high = 2.0 * std::numbers::pi / 2.0;
  return -std::log(cut_power(spectrum, high) / cut_power(spectrum, low)) / std::log(high / low);
}

TEST(Relief, PowerFallsOffWithTheStatedExponent) {
  for (const double exponent : {1.0, 2.0, 3.0}) {
    // the waves extend beyond both ends, so that neither end bends the line, and are ruled: a cut along x measures
    // every wave at its own wave number. 300 reliefs of 32 waves leave about 0.15 of scatter (measured: 0.02 to 0.12
    // wrong)
    const ReliefSpectrum spectrum{0.2, 0.5, 20.0, exponent, true};
    EXPECT_NEAR(measured_exponent(spectrum), exponent, 0.35) << "ruled";
  }
  // for waves in all directions, a cut measures each at a smaller wave number; a power law keeps its exponent
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

TEST(SlopeProfile, IsLevelThenSteepThenLevel) {
  const SlopeProfile slope{-8.0, 0.5, 3.0, 0.1};
  EXPECT_NEAR(slope.length_m(), 3.0 / std::tan(0.5), 1e-12);
  EXPECT_NEAR(slope.height_m(-12.0), 0.0, 1e-6);
  EXPECT_NEAR(slope.height_m(5.0), -3.0, 1e-6);
  const double middle_m = -8.0 + 0.5 * slope.length_m();
  EXPECT_NEAR((slope.height_m(middle_m - 0.5) - slope.height_m(middle_m + 0.5)), std::tan(0.5), 1e-3);
}

TEST(LedgeProfile, DropsAsOftenAndAsDeepAsStated) {
  const LedgeProfile ledges{-8.0, 3, 1.5, 0.1, 2.0, 0.2};
  EXPECT_EQ(ledges.height_m(-8.0), 0.0);
  EXPECT_NEAR(ledges.height_m(-7.9), -1.5, 1e-12);
  EXPECT_NEAR(ledges.height_m(-5.9), -1.5 - 2.0 * std::tan(0.2), 1e-12);
  EXPECT_NEAR(ledges.height_m(-5.8), -3.0 - 2.0 * std::tan(0.2), 1e-12);
  EXPECT_NEAR(ledges.height_m(-8.0 + 3 * 2.1), -3 * (1.5 + 2.0 * std::tan(0.2)), 1e-12);
  EXPECT_NEAR(ledges.height_m(15.0), -3 * (1.5 + 2.0 * std::tan(0.2)), 1e-12);
}

TEST(Stairs, GoDownStepByStepWithoutGaps) {
  const Flight flight{-8.0, 12, 0.17, 0.29, 2.0};
  const std::vector<Step> steps = lay_steps(flight, 0.8);
  ASSERT_EQ(steps.size(), 12u);
  double x_m = -8.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(steps[i].centre_W_m.x() - steps[i].half_m.x(), x_m, 1e-12) << i;
    x_m = steps[i].centre_W_m.x() + steps[i].half_m.x();
    EXPECT_NEAR(steps[i].centre_W_m.z() + steps[i].half_m.z(), -0.17 * static_cast<double>(i + 1), 1e-12) << i;
  }
  EXPECT_NEAR(x_m, -8.0 + flight.length_m(), 1e-12);
  EXPECT_NEAR(std::tan(flight.slope_rad()), 0.17 / 0.29, 1e-12);
}

TEST(Ground, InterpolatesBetweenNodesAndEndsAtItsRim) {
  Ground ground(5, 2.0);
  ground.transform([](double x, double y, double) { return 2.0 * x - y; });
  EXPECT_NEAR(ground.height_m(0.3, -0.7), 1.3, 1e-12);
  EXPECT_NEAR(ground.height_m(2.0, 2.0), 2.0, 1e-12);
  EXPECT_NEAR(ground.height_m(50.0, -50.0), 6.0, 1e-12);
  ground.add_near(1.0, 1.0, 0.4, [](double, double) { return 1.0; });
  EXPECT_NEAR(ground.node_m(3, 3), 2.0, 1e-12);
  EXPECT_NEAR(ground.node_m(3, 4), 3.0, 1e-12) << "out of reach";
}

TEST(Fade, RisesFromNothingToAll) {
  EXPECT_EQ(fade(0.5, 0.7, 1.9), 0.0);
  EXPECT_NEAR(fade(1.3, 0.7, 1.9), 0.5, 1e-12);
  EXPECT_EQ(fade(2.0, 0.7, 1.9), 1.0);
}

}  // namespace
}  // namespace tumble::sim
