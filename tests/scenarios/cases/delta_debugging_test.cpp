// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/delta_debugging.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using Indices = std::vector<std::size_t>;

/// Conjunction fails when all of `causes` are present.
struct Conjunction {
  std::set<std::size_t> causes;
  int trials = 0;
  int budget = 1000000;
  std::optional<bool> operator()(const Indices& kept) {
    if (trials == budget) return std::nullopt;
    ++trials;
    return std::all_of(causes.begin(), causes.end(),
                       [&](std::size_t cause) { return std::binary_search(kept.begin(), kept.end(), cause); });
  }
};

LeastSet least_of(Conjunction& test, std::size_t count) {
  return least_failing_set(count, [&](const Indices& kept) { return test(kept); });
}

TEST(LeastFailingSet, FindsEachSetOfCausesExactly) {
  for (std::size_t count : {1u, 2u, 7u, 16u}) {
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a; b < count; ++b) {
        Conjunction test{{a, b}};
        const LeastSet least = least_of(test, count);
        EXPECT_EQ(std::set<std::size_t>(least.kept.begin(), least.kept.end()), test.causes) << count;
        EXPECT_EQ(least.needed, least.kept);
        EXPECT_TRUE(least.complete);
      }
    }
  }
}

TEST(LeastFailingSet, WhatFailsWithNothingNeedsNothing) {
  Conjunction test{{}};
  const LeastSet least = least_of(test, 12);
  EXPECT_THAT(least.kept, IsEmpty());
  EXPECT_TRUE(least.complete);
  EXPECT_EQ(test.trials, 1);
  EXPECT_TRUE(least_of(test, 0).complete);
  EXPECT_EQ(test.trials, 1) << "of nothing nothing is asked";
}

TEST(LeastFailingSet, WhatNeedsAllKeepsAll) {
  Conjunction test{{0, 1, 2, 3, 4, 5, 6, 7}};
  const LeastSet least = least_of(test, 8);
  EXPECT_EQ(least.kept.size(), 8u);
  EXPECT_TRUE(least.complete);
}

// for one cause of 32, the search tries all at once, two halves at each of five levels and the cause alone once more,
// less the trials whose result is known
TEST(LeastFailingSet, ASingleCauseCostsTwoTrialsALevel) {
  for (std::size_t cause = 0; cause < 32; ++cause) {
    Conjunction test{{cause}};
    least_of(test, 32);
    EXPECT_LE(test.trials, 12) << cause;
  }
}

TEST(LeastFailingSet, AsksNothingTwice) {
  std::set<Indices> asked;
  least_failing_set(11, [&](const Indices& kept) -> std::optional<bool> {
    EXPECT_TRUE(asked.insert(kept).second);
    return std::binary_search(kept.begin(), kept.end(), 3u) && std::binary_search(kept.begin(), kept.end(), 9u);
  });
}

TEST(LeastFailingSet, ASpentBudgetLeavesASetThatFailsAndSaysSo) {
  for (int budget = 0; budget < 12; ++budget) {
    Conjunction test{{2, 13}, 0, budget};
    const LeastSet least = least_of(test, 16);
    EXPECT_TRUE(std::includes(least.kept.begin(), least.kept.end(), test.causes.begin(), test.causes.end()));
    EXPECT_FALSE(least.complete && least.kept.size() > 2) << budget;
    EXPECT_TRUE(std::includes(least.kept.begin(), least.kept.end(), least.needed.begin(), least.needed.end()));
  }
}

// either of two causes suffices: which one remains depends on the order, but only one may remain
TEST(LeastFailingSet, OfTwoSufficientCausesOneIsLeft) {
  const LeastSet least = least_failing_set(10, [](const Indices& kept) -> std::optional<bool> {
    return std::binary_search(kept.begin(), kept.end(), 1u) || std::binary_search(kept.begin(), kept.end(), 8u);
  });
  EXPECT_EQ(least.kept.size(), 1u);
}

TEST(LeastFailingNumber, BisectsToTheThresholdFromEitherSide) {
  for (const double threshold : {0.7, 3.2, 9.9}) {
    const LeastNumber above =
        least_failing_number(10.0, 0.0, 0.01, false, [&](double value) { return std::optional(value >= threshold); });
    EXPECT_TRUE(above.complete);
    EXPECT_GE(above.fails_at, threshold);
    EXPECT_LT(above.holds_at, threshold);
    EXPECT_LE(above.fails_at - above.holds_at, 0.01);
    const LeastNumber below =
        least_failing_number(-10.0, 0.0, 0.01, false, [&](double value) { return std::optional(value <= -threshold); });
    EXPECT_NEAR(below.fails_at, -threshold, 0.01);
  }
}

TEST(LeastFailingNumber, TriesWholeNumbersAlone) {
  std::vector<double> tried;
  const LeastNumber least = least_failing_number(40.0, 0.0, 1.0, true, [&](double value) {
    tried.push_back(value);
    return std::optional(value >= 17.0);
  });
  EXPECT_EQ(least.fails_at, 17.0);
  EXPECT_EQ(least.holds_at, 16.0);
  for (const double value : tried) EXPECT_EQ(value, std::round(value));
}

TEST(LeastFailingNumber, ASpentBudgetSaysSo) {
  int left = 2;
  const LeastNumber least = least_failing_number(8.0, 0.0, 0.1, false, [&](double value) -> std::optional<bool> {
    if (left-- == 0) return std::nullopt;
    return value >= 1.0;
  });
  EXPECT_FALSE(least.complete);
  EXPECT_EQ(least.fails_at, 2.0);
}

}  // namespace
}  // namespace tumble::scenarios
