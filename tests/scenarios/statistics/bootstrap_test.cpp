// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/bootstrap.hpp"

#include "sim/random/stream.hpp"
#include "tests/scenarios/statistics/samples.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

double median(std::vector<double> values) {
  return quantile(values, 0.5);
}

/// The reference implementation makes the resamples one by one. The function returns the shares of their medians at or
/// below each of the values.
std::vector<double> medians_by_resampling(const std::vector<double>& sorted, int resamples) {
  sim::Stream stream(7, "test.resampling");
  std::vector<double> below(sorted.size(), 0.0);
  for (int k = 0; k < resamples; ++k) {
    std::vector<double> resample;
    for (std::size_t i = 0; i < sorted.size(); ++i)
      resample.push_back(sorted[static_cast<std::size_t>(stream.uniform() * static_cast<double>(sorted.size()))]);
    const double m = median(resample);
    for (std::size_t i = 0; i < sorted.size(); ++i) below[i] += m <= sorted[i] ? 1.0 / resamples : 0.0;
  }
  return below;
}

std::vector<double> rising(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

// without bias and acceleration (an even, symmetric sample has neither) the ends of the interval are quantiles of the
// resamples' medians
TEST(MedianBootstrap, AgreesWithResamplesMadeOneByOne) {
  for (const std::size_t n : {10u, 11u, 24u, 51u}) {
    const std::vector<double> values = rising(n);
    const std::vector<double> below = medians_by_resampling(values, 40000);
    const Interval interval = MedianBootstrap(n, 40000).interval(values);
    EXPECT_EQ(interval.value, 0.5 * static_cast<double>(n + 1));
    const auto share_at_most = [&](double end) {
      return below[static_cast<std::size_t>(std::clamp(std::floor(end), 1.0, static_cast<double>(n))) - 1];
    };
    // medians are multiples of a half: the share crosses 2.5 and 97.5 % exactly at the end
    EXPECT_LE(share_at_most(interval.low - 1.0), 0.025 + 0.004) << n;
    EXPECT_GE(share_at_most(interval.low + 1.0), 0.025 - 0.004) << n;
    EXPECT_LE(share_at_most(interval.high - 1.0), 0.975 + 0.004) << n;
    EXPECT_GE(share_at_most(interval.high + 1.0), 0.975 - 0.004) << n;
  }
}

TEST(MedianBootstrap, IsEquivariantAndTheSameEachTime) {
  sim::Stream stream(3, "test.values");
  std::vector<double> values, moved;
  for (int i = 0; i < 31; ++i) values.push_back(std::exp(stream.normal()));
  for (const double v : values) moved.push_back(4.0 * v + 1.0);
  const Interval a = MedianBootstrap(31).interval(values), b = MedianBootstrap(31).interval(moved);
  EXPECT_NEAR(b.low, 4.0 * a.low + 1.0, 1e-12);
  EXPECT_NEAR(b.high, 4.0 * a.high + 1.0, 1e-12);
  const Interval again = MedianBootstrap(31).interval(values);
  EXPECT_EQ(again.low, a.low);
  EXPECT_EQ(again.high, a.high);
  EXPECT_LT(a.low, a.value);
  EXPECT_GT(a.high, a.value);
}

TEST(MedianBootstrap, FailuresRankAsInfiniteAndFewValuesBoundNothing) {
  std::vector<double> values = rising(20);
  for (std::size_t i = 14; i < 20; ++i) values[i] = kInfinity;
  const Interval interval = MedianBootstrap(20).interval(values);
  EXPECT_EQ(interval.value, 10.5);
  EXPECT_TRUE(std::isfinite(interval.low));
  EXPECT_FALSE(std::isnan(interval.high));
  for (std::size_t i = 5; i < 20; ++i) values[i] = kInfinity;
  EXPECT_EQ(MedianBootstrap(20).interval(values).high, kInfinity);
  EXPECT_EQ(MedianBootstrap(5).interval(rising(5)).low, -kInfinity);
  EXPECT_EQ(MedianBootstrap(5).interval(rising(5)).high, kInfinity);
  EXPECT_EQ(MedianBootstrap(20).interval(std::vector<double>(20, 3.0)).high, 3.0);
}

TEST(MedianBootstrap, RefusesWhatItCannotMean) {
  EXPECT_THROW(MedianBootstrap(0), BadInput);
  EXPECT_THROW(MedianBootstrap(10, 5), BadInput);
  EXPECT_THROW(MedianBootstrap(10).interval(rising(9)), BadInput);
  EXPECT_THROW(MedianBootstrap(10).interval(rising(10), 0.0), BadInput);
  std::vector<double> values = rising(10);
  values[3] = std::nan("");
  EXPECT_THROW(MedianBootstrap(10).interval(values), BadInput);
}

/// Returns how often the interval contains the true median, over 2000 samples of a distribution.
double coverage(std::size_t n, double risk, double (*draw)(sim::Stream&), double truth) {
  sim::Stream stream(n, "test.coverage");
  const MedianBootstrap bootstrap(n, 1000);
  int held = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i) values.push_back(draw(stream));
    const Interval interval = bootstrap.interval(values, risk);
    held += interval.low <= truth && truth <= interval.high;
  }
  return held / 2000.0;
}

// the bounds are two-sided, because an interval that is too wide is as wrong as one that is too narrow. 2000 samples
// determine a coverage to 0.5 %; the median's lattice costs up to 2 % more
TEST(MedianBootstrap, CoversTheTrueMedianAsOftenAsItSays) {
  const auto normal = [](sim::Stream& s) { return s.normal(); };
  const auto skewed = [](sim::Stream& s) { return -std::log(1.0 - s.uniform()); };
  const auto heavy = [](sim::Stream& s) { return s.normal() / s.normal(); };
  for (const std::size_t n : {12u, 60u}) {
    for (const double share :
         {coverage(n, 0.05, normal, 0.0), coverage(n, 0.05, skewed, std::log(2.0)), coverage(n, 0.05, heavy, 0.0)}) {
      EXPECT_GT(share, 0.92) << n;
      EXPECT_LT(share, 0.98) << n;
    }
  }
  // the negative controls are another level and another truth
  EXPECT_LT(coverage(60, 0.2, normal, 0.0), 0.85);
  EXPECT_LT(coverage(60, 0.05, normal, 0.4), 0.6);
}

}  // namespace
}  // namespace tumble::scenarios
