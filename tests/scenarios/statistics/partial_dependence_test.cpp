// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/dependence.hpp"
#include "sim/random/stream.hpp"
#include "tests/scenarios/statistics/samples.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kPi = std::numbers::pi;

// Ishigami and Homma's function, a = 7, b = 0.1: E[y | x1] = (1 + b pi^4/5) sin x1 + a/2, E[y | x2] = a sin^2 x2,
// E[y | x3] = a/2, each averaged over its class in closed form
TEST(PartialDependence, MatchesIshigamisFunction) {
  sim::Stream stream(6, "test.dependence");
  const std::size_t n = 20000;
  const auto a = uniform(stream, n, -kPi, kPi), b = uniform(stream, n, -kPi, kPi), c = uniform(stream, n, -kPi, kPi);
  std::vector<double> y;
  for (std::size_t i = 0; i < n; ++i)
    y.push_back(std::sin(a[i]) + 7.0 * std::pow(std::sin(b[i]), 2) + 0.1 * std::pow(c[i], 4) * std::sin(a[i]));
  const double slope = 1.0 + 0.1 * std::pow(kPi, 4) / 5.0;
  const auto of_a = [&](double l, double h) { return 3.5 + slope * (std::cos(l) - std::cos(h)) / (h - l); };
  const auto of_b = [](double l, double h) {
    return 7.0 * (0.5 - 0.25 * (std::sin(2.0 * h) - std::sin(2.0 * l)) / (h - l));
  };
  const auto of_c = [](double, double) { return 3.5; };
  const auto check = [&](const std::vector<double>& x, const auto& truth) {
    const std::vector<DependenceClass> classes = partial_dependence(x, y, Centre::mean);
    ASSERT_EQ(classes.size(), kDependenceClassesMax);
    for (const DependenceClass& each : classes) {
      EXPECT_EQ(each.draws, n / kDependenceClassesMax);
      const double half = 0.5 * (each.centre.high - each.centre.low);
      EXPECT_NEAR(each.centre.value, truth(each.low, each.high), 2.0 * half) << each.low;
      EXPECT_LT(half, 0.25);
    }
  };
  check(a, of_a);
  check(b, of_b);
  check(c, of_c);
}

// For y = x + e with symmetric e, mean and median of a class from l to h are its middle. The negative control uses the
// lower end of the class.
TEST(PartialDependence, IntervalsHoldTheTruthAsOftenAsTheySay) {
  for (const Centre centre : {Centre::mean, Centre::median}) {
    sim::Stream stream(5, "test.coverage");
    int held = 0, held_end = 0, all = 0;
    for (int k = 0; k < 500; ++k) {
      const std::vector<double> x = uniform(stream, 120, 0.0, 1.0);
      std::vector<double> y;
      for (const double each : x) y.push_back(each + 0.1 * stream.normal());
      for (const DependenceClass& each : partial_dependence(x, y, centre)) {
        ++all;
        // between the first and the last draw of a class, the other draws are uniform
        const double middle = 0.5 * (each.low + each.high);
        held += each.centre.low <= middle && middle <= each.centre.high;
        held_end += each.centre.low <= each.low && each.low <= each.centre.high;
      }
    }
    EXPECT_EQ(all, 500 * 8);
    const double most = centre == Centre::mean ? 0.98 : 0.995;  // the exact interval of 15 values has a level of 96.5 %
    EXPECT_GT(held, all * 0.94);
    EXPECT_LT(held, all * most);
    EXPECT_LT(held_end, all * 0.9);
  }
}

TEST(PartialDependence, OfFailuresIsTheirShare) {
  std::vector<double> x, y;
  for (int i = 0; i < 48; ++i) {
    x.push_back(i);
    y.push_back(i < 24 ? 0.0 : 1.0);
  }
  const std::vector<DependenceClass> classes = partial_dependence(x, y, Centre::share);
  ASSERT_EQ(classes.size(), 4u);
  EXPECT_EQ(classes[0].centre.value, 0.0);
  EXPECT_NEAR(classes[0].centre.high, 1.0 - std::pow(0.025, 1.0 / 12.0), 1e-12);
  EXPECT_EQ(classes[3].centre.value, 1.0);
  EXPECT_NEAR(classes[3].centre.low, std::pow(0.025, 1.0 / 12.0), 1e-12);
}

TEST(PartialDependence, OfFewValuesHasAClassForEach) {
  std::vector<double> x, y;
  for (int i = 0; i < 60; ++i) {
    x.push_back(i % 3);
    y.push_back(i % 3 == 2 ? std::numeric_limits<double>::infinity() : i % 3);
  }
  const std::vector<DependenceClass> classes = partial_dependence(x, y, Centre::median);
  ASSERT_EQ(classes.size(), 3u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(classes[k].low, k);
    EXPECT_EQ(classes[k].high, k);
    EXPECT_EQ(classes[k].centre.value, k);
    EXPECT_EQ(classes[k].draws, 20u);
  }
  EXPECT_TRUE(std::isinf(classes[2].centre.value)) << "a failure ranks as the worst";
}

TEST(PartialDependence, OfTooLittleIsNone) {
  const std::vector<double> x(11, 1.0);
  EXPECT_TRUE(partial_dependence(x, x, Centre::mean).empty());
  const std::vector<double> nan(40, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(partial_dependence(nan, nan, Centre::mean).empty());
  EXPECT_THROW(partial_dependence(x, std::vector<double>{1.0}, Centre::mean), BadInput);
  EXPECT_THROW(partial_dependence(std::vector<double>(20, 0.0), std::vector<double>(20, 0.5), Centre::share), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
