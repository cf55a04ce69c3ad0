// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/paired.hpp"

#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

/// The function applies the definition: over all signs, it counts how often the positive ranks add up to at least as
/// much. Ties share their mean rank.
double by_enumeration(const std::vector<double>& differences) {
  const std::size_t n = differences.size();
  std::vector<double> ranks(n);
  for (std::size_t i = 0; i < n; ++i) {
    double below = 0.0, equal = 0.0;
    for (const double other : differences) {
      below += std::abs(other) < std::abs(differences[i]);
      equal += std::abs(other) == std::abs(differences[i]);
    }
    ranks[i] = below + 0.5 * (equal + 1.0);
  }
  double own = 0.0, count = 0.0;
  for (std::size_t i = 0; i < n; ++i) own += differences[i] > 0.0 ? ranks[i] : 0.0;
  for (std::size_t signs = 0; signs < (std::size_t{1} << n); ++signs) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += (signs >> i & 1u) != 0 ? ranks[i] : 0.0;
    count += sum >= own;
  }
  return count / std::pow(2.0, static_cast<double>(n));
}

TEST(SignedRank, IsTheShareOfSignsWithSuchASum) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& differences : {std::vector<double>{1, 2, 3, 4, 5},
                                                 {-1, -2, -3},
                                                 {1, -2, 3, -4, 5, 6, 7, 8},
                                                 {1, 1, 1, -1, 2, 2, -2},
                                                 {0.3, infinity, -0.1, infinity, 2.0, -infinity}}) {
    EXPECT_NEAR(signed_rank_chance(differences), by_enumeration(differences), 1e-12);
  }
}

// Wilcoxon 1945 and all later tables agree: for ten differences a sum of 8 or less is rarer than 2.5 %, and a sum of 9
// is not
TEST(SignedRank, MatchesTheTable) {
  // the ranks are 1 to 10, and the negative ones are 1 + 7 = 8
  const std::vector<double> eight = {-1, 2, 3, 4, 5, 6, -7, 8, 9, 10};
  const std::vector<double> nine = {-1, 2, 3, 4, 5, 6, 7, -8, 9, 10};
  EXPECT_LT(signed_rank_chance(eight), 0.025);
  EXPECT_GT(signed_rank_chance(nine), 0.025);
}

TEST(SignedRank, ZerosAndNothingSayNothing) {
  EXPECT_EQ(signed_rank_chance({}), 1.0);
  EXPECT_EQ(signed_rank_chance(std::vector<double>{0.0, 0.0}), 1.0);
  EXPECT_EQ(signed_rank_chance(std::vector<double>{0.0, 1.0, std::nan("")}), 0.5);
  EXPECT_NEAR(signed_rank_chance(std::vector<double>(30, 1.0)), std::pow(0.5, 30), 1e-15);
}

/// Returns the differences 1 to n, of which those with negative signs have ranks that add up to `sum`.
std::vector<double> with_negative_sum(int n, int sum) {
  std::vector<double> differences;
  for (int rank = n; rank > 0; --rank) {
    const bool negative = rank <= sum;
    sum -= negative ? rank : 0;
    differences.push_back(negative ? -rank : rank);
  }
  EXPECT_EQ(sum, 0);
  return differences;
}

// the test uses the two-sided 5 % points of every table of the test (Conover, Practical Nonparametric Statistics, table
// A12; from 26 on other tables): the last sum that is rejected
TEST(SignedRank, MatchesTheTableOfCriticalValues) {
  const std::vector<std::pair<int, int>> table = {{6, 0},   {7, 2},   {8, 3},    {9, 5},    {10, 8},
                                                  {11, 10}, {12, 13}, {13, 17},  {14, 21},  {15, 25},
                                                  {20, 52}, {25, 89}, {30, 137}, {40, 264}, {50, 434}};
  for (const auto& [n, critical] : table) {
    EXPECT_LE(signed_rank_test(with_negative_sum(n, critical)), 0.05) << n;
    EXPECT_GT(signed_rank_test(with_negative_sum(n, critical + 1)), 0.05) << n;
  }
}

// the test compares with scipy 1.17.1: wilcoxon(d, mode="exact") of the nine pairs of Hollander and Wolfe's depression
// scores; wilcoxon(d, correction=True, mode="approx") of 120 differences with many ties
TEST(SignedRank, AgreesWithScipy) {
  const std::vector<double> depression = {-0.952, 0.147, -1.022, -0.43, -0.62, -0.59, -0.49, 0.08, -0.01};
  EXPECT_NEAR(signed_rank_test(depression), 0.0390625, 1e-12);
  std::vector<double> many;
  for (int copy = 0; copy < 3; ++copy) {
    for (int x = 1; x <= 40; ++x) many.push_back(((x * 7) % 11 < 4 ? -1.0 : 1.0) * std::ceil(x / 3.0));
  }
  ASSERT_GT(many.size(), kExactPairsMax);
  EXPECT_NEAR(signed_rank_test(many), 0.0032098257966214354, 1e-14);
  EXPECT_NEAR(signed_rank_chance(many), 0.0016049128983107177, 1e-14);
}

// with one more pair, the sum is as far from its middle: where the exact test ends, the two tests are within half a
// percent of each other
TEST(SignedRank, GoesOverIntoTheApproximation) {
  const int n = static_cast<int>(kExactPairsMax);
  for (const int sum : {1700, 2000, 2300}) {
    const double exact = signed_rank_test(with_negative_sum(n, sum));
    const double beyond = signed_rank_test(with_negative_sum(n + 1, sum + (n + 1) / 2));
    EXPECT_NEAR(beyond, exact, 0.005) << sum;
  }
}

TEST(SignedRank, IsRefusedAsOftenAsItSaysOfAlikeOnes) {
  for (const std::size_t n : {20u, 150u}) {
    sim::Stream stream(n, "test.alike");
    int refused = 0;
    for (int k = 0; k < 2000; ++k) {
      std::vector<double> differences;
      for (std::size_t i = 0; i < n; ++i) differences.push_back(stream.normal());
      refused += signed_rank_test(differences) < 0.05;
    }
    EXPECT_GT(refused, 2000 * 0.035) << n;
    EXPECT_LT(refused, 2000 * 0.065) << n;
  }
}

// the test compares with scipy 1.17.1: binomtest(3, 20).pvalue; and with statsmodels' mcnemar([[10, 5], [16, 9]],
// exact=True)
TEST(SignTest, IsBinomial) {
  std::vector<double> differences(17, 1.0);
  differences.insert(differences.end(), {-1.0, -2.0, -0.5, 0.0, std::nan("")});
  EXPECT_NEAR(sign_test(differences), 0.0025768280029296875, 1e-14);
  EXPECT_NEAR(sign_test(std::vector<double>(6, -3.0)), std::pow(0.5, 5), 1e-15);
  EXPECT_EQ(sign_test(std::vector<double>{1.0, -1.0}), 1.0);
  EXPECT_EQ(sign_test({}), 1.0);
}

// For 40 pairs, the test rejects at 13 of one sign or fewer: 3.85 %, whatever the differences' shape (Conover, table
// A3). The standard deviation of the share in 2000 tests is 0.43 %
TEST(SignTest, IsRefusedAsOftenAsItSaysOfAlikeOnes) {
  const auto refused_share = [](double shift) {
    sim::Stream stream(40, "test.signs");
    int refused = 0;
    for (int k = 0; k < 2000; ++k) {
      std::vector<double> differences;
      // the distribution is skewed and has its median at the shift: a test of means would reject it
      for (int i = 0; i < 40; ++i) differences.push_back(std::exp(1.5 * stream.normal()) - 1.0 + shift);
      refused += sign_test(differences) < 0.05;
    }
    return refused / 2000.0;
  };
  EXPECT_NEAR(refused_share(0.0), 0.0385, 3.0 * 0.0043);
  EXPECT_GT(refused_share(0.8), 0.9) << "and finds what is there";
}

TEST(PairedFailures, IsMcNemarsInItsExactForm) {
  EXPECT_NEAR(paired_failures_test(5, 16), 0.02660369873046875, 1e-14);
  EXPECT_NEAR(paired_failures_test(16, 5), 0.02660369873046875, 1e-14);
  EXPECT_EQ(paired_failures_test(0, 0), 1.0);
  EXPECT_EQ(paired_failures_test(7, 7), 1.0);
  EXPECT_NEAR(paired_failures_test(0, 10), std::pow(0.5, 9), 1e-15);
  EXPECT_THROW(paired_failures_test(-1, 3), BadInput);
}

// A fifth of the 200 draws fails under both methods: the test considers only the others. Exact tests reject at most as
// often as their level states.
TEST(PairedFailures, IsRefusedAsSeldomAsItSaysOfAlikeOnes) {
  const auto refused_share = [](double first, double second) {
    sim::Stream stream(200, "test.failures");
    int refused = 0;
    for (int k = 0; k < 2000; ++k) {
      int only_first = 0, only_second = 0;
      for (int i = 0; i < 200; ++i) {
        const bool both = stream.uniform(0.0, 1.0) < 0.2;
        const bool one = stream.uniform(0.0, 1.0) < first, other = stream.uniform(0.0, 1.0) < second;
        only_first += !both && one && !other;
        only_second += !both && other && !one;
      }
      refused += paired_failures_test(only_first, only_second) < 0.05;
    }
    return refused / 2000.0;
  };
  const double alike = refused_share(0.1, 0.1);
  EXPECT_GT(alike, 0.015);
  EXPECT_LT(alike, 0.05 + 3.0 * 0.0049);
  EXPECT_GT(refused_share(0.05, 0.2), 0.9) << "and finds what is there";
}

}  // namespace
}  // namespace tumble::scenarios
