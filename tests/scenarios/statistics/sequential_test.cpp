// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/sequential.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "scenarios/errors.hpp"
#include "sim/random/stream.hpp"

namespace tumble::scenarios {
namespace {

using Verdict = SequentialSignTest::Verdict;

/// An Enumerated contains the chance of each verdict when a sign is positive with probability `p`, and the mean number
/// of pairs until it: over all sequences of `n` signs, with a look after every `every` pairs.
struct Enumerated {
  double negative = 0.0, positive = 0.0, pairs = 0.0;
};

Enumerated enumerate(int n, int every, double p, double risk) {
  Enumerated out;
  for (unsigned signs = 0; signs < (1u << n); ++signs) {
    SequentialSignTest test(risk);
    double chance = 1.0;
    int positive = 0, seen = 0;
    for (int k = 0; k < n; ++k) {
      const bool is_positive = (signs >> k & 1u) != 0;
      chance *= is_positive ? p : 1.0 - p;
      positive += is_positive;
      if ((k + 1) % every != 0 || test.verdict() != Verdict::open) continue;
      seen = k + 1;
      test.look(static_cast<double>(seen) / n, seen - positive, positive);
    }
    out.pairs += chance * seen;
    if (test.verdict() == Verdict::positive) out.positive += chance;
    if (test.verdict() == Verdict::negative) out.negative += chance;
  }
  return out;
}

TEST(SpentBy, IsNothingAtFirstAndHalfOfTheRiskASideAtTheEnd) {
  EXPECT_EQ(spent_by(0.05, 0.0), 0.0);
  EXPECT_NEAR(spent_by(0.05, 1.0), 0.025, 1e-12);
  EXPECT_LT(spent_by(0.05, 0.2), 1e-6);
  // Lan and DeMets' formula is 2 (1 - Phi(2.2414 / sqrt(0.5)))
  EXPECT_NEAR(spent_by(0.05, 0.5), 2.0 * 0.5 * std::erfc(2.241402728 / std::sqrt(0.5) / std::sqrt(2.0)), 1e-9);
}

// the risk that the test states as spent equals the sum over all sequences of fair signs
TEST(SequentialSignTest, SpendsWhatItSays) {
  for (const int every : {1, 4}) {
    const int n = 16;
    SequentialSignTest last(0.1);
    for (int seen = every; seen <= n; seen += every) {
      last.look(static_cast<double>(seen) / n, seen / 2, seen - seen / 2);
    }
    const Enumerated fair = enumerate(n, every, 0.5, 0.1);
    EXPECT_NEAR(fair.positive + fair.negative, last.spent(), 1e-12);
    EXPECT_NEAR(fair.positive, fair.negative, 1e-12);
    EXPECT_LE(last.spent(), 0.1);
    EXPECT_GT(last.spent(), 0.05);  // whole numbers use a part of the risk
  }
}

// with unequal signs the test reaches the right verdict, and before the end
TEST(SequentialSignTest, HasPowerAndStopsEarly) {
  const Enumerated uneven = enumerate(16, 4, 0.9, 0.1);
  EXPECT_GT(uneven.positive, 0.9);
  EXPECT_LT(uneven.negative, 1e-4);
  EXPECT_LT(uneven.pairs, 14.0);
}

// With one look the test is the sign test: of 10 pairs 9 are needed at 5 %.
TEST(SequentialSignTest, OfOneLookIsTheSignTest) {
  SequentialSignTest test(0.05);
  EXPECT_EQ(test.look(1.0, 2, 8), Verdict::open);
  EXPECT_EQ(test.needed(), 9);
  EXPECT_NEAR(test.spent(), 2.0 * 11.0 / 1024.0, 1e-12);
  EXPECT_EQ(SequentialSignTest(0.05).look(1.0, 9, 1), Verdict::negative);
}

// The bounds of five equally spaced looks, two-sided 5 %, are in Lan and DeMets' table for O'Brien and Fleming's
// spending
TEST(SequentialSignTest, OfManyPairsHasThePublishedBounds) {
  const std::vector<double> published = {4.8769, 3.3569, 2.6803, 2.2898, 2.0310};
  SequentialSignTest test(0.05);
  for (std::size_t k = 0; k < published.size(); ++k) {
    const auto pairs = static_cast<std::int64_t>(2000 * (k + 1));
    test.look(0.2 * static_cast<double>(k + 1), pairs / 2, pairs / 2);
    const double root = std::sqrt(static_cast<double>(pairs));
    const double bound = static_cast<double>(2 * test.needed() - pairs) / root;
    // signs are whole numbers: one more sign moves the bound by 2/sqrt(pairs)
    EXPECT_NEAR(bound, published[k], 2.0 / root + 0.005) << k;
  }
}

struct Simulated {
  double answered = 0.0, pairs = 0.0;
};

/// Simulates 200 draws in ten looks, with differences of which a third are zero.
Simulated simulate(double p, int runs) {
  sim::Stream random(7, "test.sequential");
  Simulated out;
  for (int run = 0; run < runs; ++run) {
    SequentialSignTest test(0.05);
    std::int64_t negative = 0, positive = 0;
    for (int draw = 1; draw <= 200 && test.verdict() == Verdict::open; ++draw) {
      if (random.uniform() >= 1.0 / 3.0) (random.uniform() < p ? positive : negative) += 1;
      if (draw % 20 == 0) test.look(draw / 200.0, negative, positive);
    }
    out.answered += test.verdict() != Verdict::open;
    out.pairs += static_cast<double>(negative + positive);
  }
  out.answered /= runs;
  out.pairs /= runs;
  return out;
}

// the level is kept whatever share of the draws are ties, and little of it is lost; the tolerance is four standard
// errors of the simulation
TEST(SequentialSignTest, KeepsItsLevelBySimulation) {
  constexpr int kRuns = 4000;
  const double error = std::sqrt(0.05 * 0.95 / kRuns);
  const Simulated fair = simulate(0.5, kRuns);
  EXPECT_LT(fair.answered, 0.05 + 4.0 * error);
  EXPECT_GT(fair.answered, 0.035 - 4.0 * error);
}

// with 133 pairs and signs of 0.65, a test with one look has power 0.94 (normal approximation: the looks cost a little)
TEST(SequentialSignTest, KeepsItsPowerBySimulation) {
  const Simulated uneven = simulate(0.65, 2000);
  EXPECT_GT(uneven.answered, 0.88);
  EXPECT_LT(uneven.answered, 0.97);
  EXPECT_LT(uneven.pairs, 100.0);
}

// Control: when the same test uses all of its risk at each look, it finds differences that do not exist
TEST(SequentialSignTest, WithoutSpendingWouldNotKeepIt) {
  sim::Stream random(8, "test.sequential");
  int answered = 0;
  for (int run = 0; run < 1000; ++run) {
    std::int64_t negative = 0, positive = 0;
    bool found = false;
    for (int draw = 1; draw <= 200 && !found; ++draw) {
      (random.uniform() < 0.5 ? positive : negative) += 1;
      if (draw % 20 == 0) found = SequentialSignTest(0.05).look(1.0, negative, positive) != Verdict::open;
    }
    answered += found;
  }
  EXPECT_GT(answered, 100);
}

TEST(SequentialSignTest, AnswersOnceAndRefusesWhatCannotBe) {
  SequentialSignTest test(0.05);
  EXPECT_EQ(test.look(0.5, 0, 40), Verdict::positive);
  EXPECT_EQ(test.look(1.0, 60, 40), Verdict::positive);
  EXPECT_THROW(SequentialSignTest(0.0), BadInput);
  EXPECT_THROW(SequentialSignTest{std::numeric_limits<double>::quiet_NaN()}, BadInput);
  SequentialSignTest other(0.05);
  EXPECT_THROW(other.look(0.0, 1, 1), BadInput);
  EXPECT_THROW(other.look(1.5, 1, 1), BadInput);
  other.look(0.5, 5, 5);
  EXPECT_THROW(other.look(0.4, 6, 6), BadInput);
  EXPECT_THROW(other.look(0.6, 4, 5), BadInput);
}

// before there are enough pairs for any conclusion, no outcome is an answer
TEST(SequentialSignTest, OfLittleNothingIsAnAnswer) {
  SequentialSignTest test(0.05);
  EXPECT_EQ(test.look(0.05, 0, 5), Verdict::open);
  EXPECT_EQ(test.needed(), 6);
  EXPECT_EQ(test.spent(), 0.0);
}

}  // namespace
}  // namespace tumble::scenarios
