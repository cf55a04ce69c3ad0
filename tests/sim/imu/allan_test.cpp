// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/allan.hpp"

#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

std::vector<double> white(std::size_t count, double sigma, std::uint64_t seed = 1) {
  Stream stream(seed, "test");
  std::vector<double> samples(count);
  for (double& sample : samples) sample = sigma * stream.normal();
  return samples;
}

std::vector<double> walk(std::size_t count, double step, std::uint64_t seed = 1) {
  std::vector<double> samples = white(count, step, seed);
  for (std::size_t i = 1; i < count; ++i) samples[i] += samples[i - 1];
  return samples;
}

TEST(Allan, AgreesWithTheDefinitionOnASeriesWorkedByHand) {
  // the means of pairs are 1.5 3.0 5.5 7.5 6.0 5.0 7.5 8.5; the overlapping pairs are two apart, and the result is half
  // of the mean squared difference
  const std::vector<double> series = {1, 2, 4, 7, 8, 4, 6, 9, 8, 2, 0, 3, 5, 1, 4, 6, 7, 2};
  double sum_1 = 0.0, sum_2 = 0.0;
  for (std::size_t i = 0; i + 1 < series.size(); ++i) sum_1 += std::pow(series[i + 1] - series[i], 2);
  for (std::size_t i = 0; i + 3 < series.size(); ++i)
    sum_2 += std::pow((series[i + 2] + series[i + 3] - series[i] - series[i + 1]) / 2.0, 2);
  const auto curve = allan_deviation(series, 0.5, 10);
  ASSERT_EQ(curve.size(), 2u);  // clusters of 1 and 2: at most a ninth of 18 samples
  EXPECT_NEAR(curve[0].deviation, std::sqrt(sum_1 / 2.0 / 17.0), 1e-14);
  EXPECT_NEAR(curve[1].deviation, std::sqrt(sum_2 / 2.0 / 15.0), 1e-14);
  EXPECT_EQ(curve[1].tau_s, 1.0);
}

TEST(Allan, WhiteNoiseFallsWithTheRootOfTime) {
  const auto curve = allan_deviation(white(100'000, 0.3), 0.01);
  ASSERT_GT(curve.size(), 15u);
  int inside = 0;
  for (const AllanPoint& point : curve) {
    const double expected = white_deviation(0.3 * std::sqrt(0.01), point.tau_s);
    // false alarm rate 0.05 % per point
    const AllanInterval interval = confidence_interval(point, AllanNoise::white, 3.5);
    EXPECT_LT(interval.low, expected) << point.tau_s << " s";
    EXPECT_GT(interval.high, expected) << point.tau_s << " s";
    const AllanInterval narrow = confidence_interval(point, AllanNoise::white, 1.0);
    inside += narrow.low < expected && expected < narrow.high ? 1 : 0;
  }
  EXPECT_GT(inside, 6);  // two thirds of about 20 points; neighbours are correlated
}

TEST(Allan, RandomWalkRisesWithTheRootOfTime) {
  const double step = 0.02, period_s = 0.1;
  const auto curve = allan_deviation(walk(50'000, step), period_s);
  for (const AllanPoint& point : curve) {
    // the variance of a discrete random walk is 1 + 1/(2 m^2) times that of the continuous one
    if (point.cluster < 10) continue;
    const double expected = walk_deviation(step / std::sqrt(period_s), point.tau_s);
    const AllanInterval interval = confidence_interval(point, AllanNoise::walk, 3.5);
    EXPECT_LT(interval.low, expected) << point.tau_s << " s";
    EXPECT_GT(interval.high, expected) << point.tau_s << " s";
  }
}

TEST(Allan, IntervalsHoldAsOftenAsTheyClaim) {
  // in 300 series of white noise with clusters of 16 of 400 samples, 2 sigma contain the truth in 95.4 %; 3.5 standard
  // errors are 4.2 %
  int held = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    const auto curve = allan_deviation(white(400, 1.0, 100 + run), 1.0);
    const AllanPoint& point = nearest_point(curve, 16.0);
    const AllanInterval interval = confidence_interval(point, AllanNoise::white, 2.0);
    const double expected = white_deviation(1.0, point.tau_s);
    held += interval.low < expected && expected < interval.high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(held) / kRuns, 0.954, 0.05);
}

TEST(Allan, IntervalRefusesATenthMoreNoise) {
  // negative control: 100 000 samples distinguish a difference of 10 % at short times
  const AllanPoint point = allan_deviation(white(100'000, 1.1), 1.0).front();
  EXPECT_GT(confidence_interval(point, AllanNoise::white, 3.0).low, 1.0);
}

TEST(Allan, GaussMarkovTendsToItsTwoLimits) {
  // far below the correlation time the process is a random walk of sigma sqrt(2 / T), and far above it white noise of
  // sigma sqrt(2 T)
  EXPECT_NEAR(gauss_markov_deviation(0.1, 100.0, 0.02) / walk_deviation(0.1 * std::sqrt(2.0 / 100.0), 0.02), 1.0, 1e-3);
  EXPECT_NEAR(gauss_markov_deviation(0.1, 1.0, 1e4) / white_deviation(0.1 * std::sqrt(2.0), 1e4), 1.0, 1e-3);
  EXPECT_NEAR(gauss_markov_deviation(0.1, 100.0, 0.0999999) / gauss_markov_deviation(0.1, 100.0, 0.1000001), 1.0, 1e-5);
  EXPECT_NEAR(gauss_markov_deviation(1.0, 100.0, 189.0), 0.6174, 1e-3);  // maximum: 0.437 sqrt(2), at 1.89 T
}

TEST(Allan, MeanOfAxesCountsThemAll) {
  std::vector<std::vector<AllanPoint>> axes;
  for (std::uint64_t axis = 0; axis < 3; ++axis) axes.push_back(allan_deviation(white(9000, 2.0, axis), 0.1));
  const auto mean = mean_deviation(axes);
  ASSERT_EQ(mean.size(), axes[0].size());
  EXPECT_EQ(mean[4].series, 3u);
  EXPECT_NEAR(std::pow(mean[4].deviation, 2) * 3.0,
              std::pow(axes[0][4].deviation, 2) + std::pow(axes[1][4].deviation, 2) + std::pow(axes[2][4].deviation, 2),
              1e-12);
  EXPECT_NEAR(degrees_of_freedom(mean[4], AllanNoise::flicker),
              3.0 * degrees_of_freedom(axes[0][4], AllanNoise::flicker), 1e-9);
  axes[1].pop_back();
  EXPECT_THROW(mean_deviation(axes), std::invalid_argument);
}

TEST(Allan, MeanOfTheSeriesDoesNotMatter) {
  std::vector<double> series = white(1000, 1e-4);
  const auto before = allan_deviation(series, 1.0);
  for (double& sample : series) sample += 9.80665;
  const auto after = allan_deviation(series, 1.0);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(after[i].deviation, before[i].deviation, 1e-7 * before[i].deviation);
}

TEST(Allan, RefusesWhatMeansNothing) {
  const std::vector<double> series = white(100, 1.0);
  EXPECT_THROW(allan_deviation(series, 0.0), std::invalid_argument);
  EXPECT_THROW(allan_deviation(series, std::nan("")), std::invalid_argument);
  EXPECT_THROW(allan_deviation(series, 1.0, 0), std::invalid_argument);
  EXPECT_TRUE(allan_deviation(std::vector<double>(8, 1.0), 1.0).empty());
  std::vector<double> broken = series;
  broken[50] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(allan_deviation(broken, 1.0), std::invalid_argument);
  EXPECT_THROW(confidence_interval(allan_deviation(series, 1.0).front(), AllanNoise::white, 0.0),
               std::invalid_argument);
  EXPECT_THROW(nearest_point({}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::sim
