// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/dependence.hpp"

#include "sim/random/stream.hpp"
#include "tests/scenarios/statistics/samples.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

TEST(MeanRanks, ShareTheirMeanInTies) {
  EXPECT_THAT(mean_ranks(std::vector<double>{3.0, 1.0, kInfinity, 1.0, -kInfinity, kInfinity}),
              ElementsAre(4.0, 2.5, 5.5, 2.5, 1.0, 5.5));
  EXPECT_TRUE(std::isnan(mean_ranks(std::vector<double>{1.0, std::nan("")})[1]));
}

// the test uses the textbook's ten pairs (IQ and hours of television: -29/165), and scipy 1.17.1: spearmanr of 60 pairs
// with ties
TEST(RankCorrelation, AgreesWithTheTextbookAndScipy) {
  const std::vector<double> iq = {106, 100, 86, 101, 99, 103, 97, 113, 112, 110};
  const std::vector<double> hours = {7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
  const Correlation television = rank_correlation(iq, hours);
  EXPECT_NEAR(television.rho, -29.0 / 165.0, 1e-12);
  EXPECT_NEAR(television.chance, 0.6271883447764846, 1e-12);
  std::vector<double> x, y;
  for (int i = 0; i < 60; ++i) {
    x.push_back((i * 37) % 101);
    y.push_back(std::floor(((i * i * 13) % 89 + 0.3 * ((i * 37) % 101)) / 7.0));
  }
  EXPECT_NEAR(rank_correlation(x, y).rho, 0.4508179715469104, 1e-12);
  EXPECT_NEAR(rank_correlation(x, y).chance, 0.000300621602362884, 1e-12);
}

TEST(RankCorrelation, SeesOrderAloneAndFailuresAsTheLast) {
  const std::vector<double> x = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const std::vector<double> y = {0.1, 0.2, 0.3, 1, 10, 1e3, 1e6, 1e9, kInfinity, kInfinity};
  EXPECT_GT(rank_correlation(x, y).rho, 0.99);
  EXPECT_LT(rank_correlation(x, y).chance, 1e-6);
  EXPECT_EQ(rank_correlation(x, x).rho, 1.0);
  EXPECT_EQ(rank_correlation(x, x).chance, 0.0);
  EXPECT_EQ(rank_correlation(x, x).low, 1.0);
  // a few pairs, or constant values, allow no conclusion
  EXPECT_EQ(rank_correlation(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2, 3}).chance, 1.0);
  EXPECT_EQ(rank_correlation(x, std::vector<double>(10, 2.0)).chance, 1.0);
  EXPECT_EQ(rank_correlation(x, std::vector<double>(10, 2.0)).high, 1.0);
  EXPECT_THROW(rank_correlation(x, std::vector<double>{1.0}), BadInput);
}

// the rank correlation of normal pairs with correlation r is 6/pi asin(r/2)
TEST(RankCorrelation, IntervalsHoldTheTruthAsOftenAsTheySay) {
  for (const double r : {0.0, 0.5, 0.8}) {
    const double truth = 6.0 / std::numbers::pi * std::asin(0.5 * r);
    sim::Stream stream(5, "test.rho");
    int held = 0, refused = 0;
    for (int k = 0; k < 2000; ++k) {
      std::vector<double> x, y;
      for (int i = 0; i < 50; ++i) {
        x.push_back(stream.normal());
        y.push_back(r * x.back() + std::sqrt(1.0 - r * r) * stream.normal());
      }
      const Correlation c = rank_correlation(x, y);
      held += c.low <= truth && truth <= c.high;
      refused += c.chance < 0.05;
    }
    EXPECT_GT(held, 2000 * 0.93) << r;
    EXPECT_LT(held, 2000 * 0.97) << r;
    if (r == 0.0) {
      EXPECT_GT(refused, 2000 * 0.035);
      EXPECT_LT(refused, 2000 * 0.065);
    } else {
      EXPECT_GT(refused, 2000 * 0.9) << "negative control";
    }
  }
}

// for y = x in M classes of k values, the variance within a class is (k^2 - 1)/12 of (n^2 - 1)/12
TEST(FirstOrder, OfItselfIsWhatTheClassesLeave) {
  std::vector<double> x;
  for (int i = 0; i < 1000; ++i) x.push_back(i);
  const FirstOrder all = first_order_index(x, x);
  EXPECT_EQ(all.classes, 15u);
  EXPECT_NEAR(all.index, 1.0 - 1.0 / (15.0 * 15.0), 2e-3);
  EXPECT_LT(all.chance, 1e-100);
}

// For Ishigami and Homma's function with a = 7, b = 0.1, the indices in closed form are 0.3139, 0.4424 and 0. The
// second variable's influence has a shape that no rank correlation detects.
TEST(FirstOrder, MatchesIshigamisFunction) {
  sim::Stream stream(6, "test.ishigami");
  const double pi = std::numbers::pi;
  const std::size_t n = 20000;
  const auto a = uniform(stream, n, -pi, pi), b = uniform(stream, n, -pi, pi), c = uniform(stream, n, -pi, pi);
  std::vector<double> y;
  for (std::size_t i = 0; i < n; ++i)
    y.push_back(std::sin(a[i]) + 7.0 * std::pow(std::sin(b[i]), 2) + 0.1 * std::pow(c[i], 4) * std::sin(a[i]));
  EXPECT_NEAR(first_order_index(a, y).index, 0.3139, 0.015);
  EXPECT_NEAR(first_order_index(b, y).index, 0.4424, 0.015);
  EXPECT_NEAR(first_order_index(c, y).index, 0.0, 0.005);
  EXPECT_LT(std::abs(rank_correlation(b, y).rho), 0.03);
}

// for y = x1 + 2 x2 with uniform numbers, the indices are 1/5 and 4/5
TEST(FirstOrder, PartsTheVarianceOfASum) {
  sim::Stream stream(8, "test.sum");
  const auto a = uniform(stream, 3000), b = uniform(stream, 3000);
  std::vector<double> y;
  for (std::size_t i = 0; i < a.size(); ++i) y.push_back(a[i] + 2.0 * b[i]);
  EXPECT_NEAR(first_order_index(a, y).index, 0.2, 0.03);
  EXPECT_NEAR(first_order_index(b, y).index, 0.8, 0.03);
}

// the expected chance is from scipy 1.17.1: kruskal of four groups, H = 3.6216 with 3 degrees of freedom
TEST(FirstOrder, ChanceOfRanksIsKruskalAndWallis) {
  std::vector<double> x, y;
  for (int i = 0; i < 60; ++i) {
    x.push_back(i % 4);
    y.push_back((i * i * 13) % 89 + (i % 4 == 2 ? 5 : 0));
  }
  const FirstOrder index = first_order_index(x, mean_ranks(y));
  EXPECT_EQ(index.classes, 4u) << "one for each value";
  EXPECT_NEAR(index.chance, 0.30532559745987664, 1e-12);
}

TEST(FirstOrder, OfNothingIsNothing) {
  for (const std::size_t n : {40u, 400u}) {
    sim::Stream stream(n, "test.nothing");
    double sum = 0.0;
    int refused = 0;
    for (int k = 0; k < 2000; ++k) {
      const FirstOrder index = first_order_index(uniform(stream, n), mean_ranks(uniform(stream, n)));
      sum += index.index;
      refused += index.chance < 0.05;
    }
    // the index is limited to zero from below, so its mean is a little above zero; without correction it would be (M -
    // 1)/(n - 1): 0.10 and 0.025
    EXPECT_LT(sum / 2000.0, n == 40 ? 0.045 : 0.008) << n;
    EXPECT_GT(refused, 2000 * 0.025) << n;
    EXPECT_LT(refused, 2000 * 0.065) << n;
  }
  EXPECT_EQ(first_order_index(std::vector<double>(50, 1.0), std::vector<double>(50, 2.0)).classes, 0u);
  EXPECT_EQ(first_order_index(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2, 3}).chance, 1.0);
}

}  // namespace
}  // namespace tumble::scenarios
