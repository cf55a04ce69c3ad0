// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/confidence_sequence.hpp"

#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

// with successes alone, (n + 1) p^n = risk at the lower limit
TEST(ProbabilityAtAnyTime, HasAClosedFormWithoutFailures) {
  for (const int n : {1, 7, 40}) {
    const Interval all = probability_at_any_time(n, 0, 0.05);
    EXPECT_NEAR(all.low, std::pow(0.05 / (n + 1.0), 1.0 / n), 1e-12);
    EXPECT_EQ(all.high, 1.0);
    EXPECT_EQ(all.value, 1.0);
    const Interval none = probability_at_any_time(0, n, 0.05);
    EXPECT_NEAR(none.high, 1.0 - all.low, 1e-12);
    EXPECT_EQ(none.low, 0.0);
  }
}

// (n + 1) C(n, k) p^k (1 - p)^(n - k) equals the risk at both limits
TEST(ProbabilityAtAnyTime, SolvesItsEquation) {
  const Interval some = probability_at_any_time(30, 10, 0.01);
  for (const double p : {some.low, some.high}) {
    const double log_pmf =
        std::lgamma(41.0) - std::lgamma(31.0) - std::lgamma(11.0) + 30.0 * std::log(p) + 10.0 * std::log(1.0 - p);
    EXPECT_NEAR(41.0 * std::exp(log_pmf), 0.01, 1e-9);
  }
  EXPECT_LT(some.low, 0.75);
  EXPECT_GT(some.high, 0.75);
}

struct Simulated {
  double excluded = 0.0;     ///< share of the sequences that exclude ½ at any time
  double mean_trials = 0.0;  ///< until ½ is excluded, or all
};

Simulated simulate(double p, int trials, int sequences) {
  sim::Stream random(7, "test.confidence_sequence");
  Simulated out;
  for (int run = 0; run < sequences; ++run) {
    std::int64_t successes = 0, failures = 0;
    bool excluded = false;
    while (!excluded && successes + failures < trials) {
      (random.uniform() < p ? successes : failures) += 1;
      const Interval interval = probability_at_any_time(successes, failures, 0.05);
      excluded = interval.low > 0.5 || interval.high < 0.5;
    }
    out.excluded += excluded;
    out.mean_trials += static_cast<double>(successes + failures);
  }
  out.excluded /= sequences;
  out.mean_trials /= sequences;
  return out;
}

// the tolerance is four standard errors of the simulation
TEST(ProbabilityAtAnyTime, KeepsItsRiskAlthoughEveryTrialIsTested) {
  EXPECT_LT(simulate(0.5, 200, 400).excluded, 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 400));
}

TEST(ProbabilityAtAnyTime, ExcludesEqualityAfterFewTrials) {
  const Simulated uneven = simulate(0.75, 400, 200);
  EXPECT_EQ(uneven.excluded, 1.0);
  EXPECT_LT(uneven.mean_trials, 40.0);
}

// control: the limits of a single test, used after every trial, exclude ½ too often
TEST(ProbabilityAtAnyTime, TheLimitsOfASingleTestWouldNotKeepTheRisk) {
  sim::Stream random(8, "test.confidence_sequence");
  int excluded = 0;
  for (int run = 0; run < 1000; ++run) {
    int balance = 0;
    bool found = false;
    for (int n = 1; n <= 400 && !found; ++n) {
      balance += random.uniform() < 0.5 ? 1 : -1;
      found = n >= 10 && std::abs(balance) > 1.96 * std::sqrt(n);
    }
    excluded += found;
  }
  EXPECT_GT(excluded, 200);
}

TEST(ProbabilityAtAnyTime, WithoutTrialsContainsEverything) {
  const Interval empty = probability_at_any_time(0, 0, 0.05);
  EXPECT_EQ(empty.low, 0.0);
  EXPECT_EQ(empty.high, 1.0);
}

TEST(ProbabilityAtAnyTime, RefusesWrongCountsAndRisks) {
  EXPECT_THROW(probability_at_any_time(-1, 3, 0.05), BadInput);
  EXPECT_THROW(probability_at_any_time(3, -1, 0.05), BadInput);
  EXPECT_THROW(probability_at_any_time(1, 1, 0.0), BadInput);
  EXPECT_THROW(probability_at_any_time(1, 1, std::numeric_limits<double>::quiet_NaN()), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
