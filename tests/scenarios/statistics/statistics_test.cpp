// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/statistics.hpp"

#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

TEST(Quantile, IsTypeSeven) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 1.0), 4.0);
  EXPECT_EQ(quantile(values, 0.5), 2.5);
  EXPECT_NEAR(quantile(values, 0.25), 1.75, 1e-15);
  EXPECT_NEAR(quantile(values, 0.9), 3.7, 1e-15);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_THROW(quantile(values, 1.1), BadInput);
}

TEST(Quantile, RanksFailuresAsInfinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantile(std::vector{1.0, 3.0, kInfinity}, 0.5), 3.0);
  EXPECT_EQ(quantile(std::vector{1.0, 3.0, kInfinity}, 0.75), kInfinity);
  EXPECT_EQ(quantile(std::vector{-kInfinity, 3.0, 4.0}, 0.25), -kInfinity);
  EXPECT_EQ(quantile(std::vector{kInfinity, kInfinity}, 0.5), kInfinity);
}

// the ranks of the 95 % interval of the median are those in tables of the sign test (Conover, table A3)
TEST(MedianInterval, RanksAreThoseOfTheTables) {
  struct Row {
    int n;
    double low, high;
  };
  for (const Row& row : {Row{6, 1, 6}, Row{8, 1, 8}, Row{9, 2, 8}, Row{10, 2, 9}, Row{15, 4, 12}, Row{20, 6, 15},
                         Row{25, 8, 18}, Row{30, 10, 21}, Row{50, 18, 33}, Row{100, 40, 61}}) {
    std::vector<double> values(static_cast<std::size_t>(row.n));
    std::iota(values.rbegin(), values.rend(), 1.0);
    const Interval interval = median_interval(values);
    EXPECT_EQ(interval.value, 0.5 * (row.n + 1)) << row.n;
    EXPECT_EQ(interval.low, row.low) << row.n;
    EXPECT_EQ(interval.high, row.high) << row.n;
  }
}

// the reference sorts the values and sums all terms, for few and many values, with ties and infinities
TEST(MedianInterval, IsThatOfTheSortedValuesToTheLastBit) {
  for (const std::size_t count : {1, 2, 5, 6, 7, 8, 60, 61, 1000, 1001, 1500, 1501, 4000, 30001}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(std::fmod(7919.0 * static_cast<double>(i), 0.7 * static_cast<double>(count) + 1.0));
      if (i % 41 == 40) values.back() = std::numeric_limits<double>::infinity();
    }
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const auto n = static_cast<double>(count);
    std::size_t rank = 0;
    double cumulative = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto below = static_cast<double>(k);
      cumulative +=
          std::exp(std::lgamma(n + 1) - std::lgamma(below + 1) - std::lgamma(n - below + 1) - n * std::log(2.0));
      if (cumulative > 0.025) break;
      rank = k + 1;
    }
    const Interval interval = median_interval(values);
    EXPECT_EQ(interval.value, quantile(values, 0.5)) << count;
    EXPECT_EQ(interval.low, rank == 0 ? -std::numeric_limits<double>::infinity() : sorted[rank - 1]) << count;
    EXPECT_EQ(interval.high, rank == 0 ? std::numeric_limits<double>::infinity() : sorted[count - rank]) << count;
  }
}

// the coverage depends only on the ranks, whatever the distribution: 96.48 % of 15, 95.67 % of 25, 96.48 % of 100
// values (binomial)
TEST(MedianInterval, CoversTheTrueMedianAsOftenAsItSays) {
  for (const auto& [n, said] : {std::pair{15, 0.9648}, {25, 0.9567}, {100, 0.9648}}) {
    sim::Stream stream(static_cast<std::uint64_t>(n), "test.median");
    int covered = 0;
    for (int k = 0; k < 4000; ++k) {
      std::vector<double> values;
      for (int i = 0; i < n; ++i) values.push_back(std::exp(stream.normal()));  // median 1, mean 1.65
      const Interval interval = median_interval(values);
      covered += interval.low <= 1.0 && 1.0 <= interval.high;
    }
    EXPECT_NEAR(covered / 4000.0, said, 3.0 * std::sqrt(said * (1.0 - said) / 4000.0)) << n;
  }
}

TEST(MedianInterval, TooFewValuesBoundNothing) {
  const Interval interval = median_interval(std::vector<double>{1, 2, 3, 4, 5});
  EXPECT_EQ(interval.value, 3.0);
  EXPECT_EQ(interval.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(interval.high, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(median_interval({}).value));
}

// the limits are Clopper and Pearson's; 0 of n has the closed form 1 - 0.025^(1/n)
TEST(ShareInterval, AgreesWithPublishedLimits) {
  struct Row {
    int count, total;
    double low, high;
  };
  for (const Row& row : {Row{12, 32, 0.2110, 0.5631}, Row{1, 10, 0.0025, 0.4450}, Row{5, 10, 0.1871, 0.8129},
                         Row{10, 100, 0.0490, 0.1762}, Row{2, 20, 0.0123, 0.3170}, Row{95, 100, 0.8872, 0.9836}}) {
    const Interval interval = share_interval(row.count, row.total);
    EXPECT_EQ(interval.value, static_cast<double>(row.count) / row.total);
    EXPECT_NEAR(interval.low, row.low, 6e-5) << row.count << " of " << row.total;
    EXPECT_NEAR(interval.high, row.high, 6e-5) << row.count << " of " << row.total;
  }
}

TEST(ShareInterval, EndsAreExact) {
  for (const int n : {1, 12, 32, 1000, 100000}) {
    const double bound = -std::expm1(std::log(0.025) / n);
    EXPECT_EQ(share_interval(0, n).low, 0.0);
    EXPECT_NEAR(share_interval(0, n).high, bound, 1e-12);
    EXPECT_EQ(share_interval(n, n).high, 1.0);
    EXPECT_NEAR(share_interval(n, n).low, 1.0 - bound, 1e-12);
  }
  EXPECT_NEAR(share_interval(0, 12).high, 0.2646, 1e-4);
  // negative control: the normal approximation would give 0
  EXPECT_GT(share_interval(0, 1000).high, 0.003);
  EXPECT_TRUE(std::isnan(share_interval(0, 0).value));
  EXPECT_THROW(share_interval(5, 4), BadInput);
}

// by definition of the limits, the binomial tail beyond the count is 2.5 % there
TEST(ShareInterval, LimitsLeaveTheirTails) {
  const int n = 40;
  for (int count = 1; count < n; ++count) {
    const Interval interval = share_interval(count, n);
    const auto tail = [&](double p, int first, int last) {
      double sum = 0.0;
      for (int k = first; k <= last; ++k) {
        sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                        (n - k) * std::log1p(-p));
      }
      return sum;
    };
    EXPECT_NEAR(tail(interval.low, count, n), 0.025, 1e-10) << count;
    EXPECT_NEAR(tail(interval.high, 0, count), 0.025, 1e-10) << count;
  }
}

// exact intervals cover at least as often as they state, also for shares near 0 and few draws
TEST(ShareInterval, CoversTheTrueShareAtLeastAsOftenAsItSays) {
  for (const int n : {12, 60, 400}) {
    for (const double share : {0.02, 0.1, 0.5}) {
      sim::Stream stream(static_cast<std::uint64_t>(n), "test.share");
      int covered = 0, by_normal = 0;
      for (int k = 0; k < 4000; ++k) {
        int count = 0;
        for (int i = 0; i < n; ++i) count += stream.uniform(0.0, 1.0) < share;
        const Interval interval = share_interval(count, n);
        covered += interval.low <= share && share <= interval.high;
        const double p = static_cast<double>(count) / n;
        by_normal += std::abs(p - share) <= 1.96 * std::sqrt(p * (1.0 - p) / n);
      }
      EXPECT_GT(covered / 4000.0, 0.95 - 3.0 * 0.0035) << share << " of " << n;
      const bool seldom = share < 0.05 && n < 100, many = n == 400 && share > 0.4;
      EXPECT_LT(by_normal / 4000.0, seldom ? 0.8 : 1.0) << "negative control: the normal approximation";
      EXPECT_LE(covered / 4000.0, many ? 0.97 : 1.0) << "and is no wider than it must be";
    }
  }
}

}  // namespace
}  // namespace tumble::scenarios
