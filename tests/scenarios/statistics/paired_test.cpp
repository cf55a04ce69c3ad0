// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/paired.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace tumble::scenarios {
namespace {

/// The definition: over all signs, how often the positive ranks add up to as much. Ties share their mean rank.
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

// Wilcoxon 1945 and every table since: of ten differences a sum of 8 or less is rarer than 2.5 %, one of 9 is not
TEST(SignedRank, MatchesTheTable) {
  // ranks 1..10; negatives 1 + 7 = 8
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

}  // namespace
}  // namespace tumble::scenarios
