// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/splitting.hpp"

#include <boost/math/distributions/normal.hpp>

#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t kUnlimited = 1000000;
constexpr int kRepetitions = 200;

using PointScore = std::function<double(const SplittingPoint&)>;

ScorePoints each(const PointScore& score) {
  return [score](std::span<const SplittingPoint> points) {
    std::vector<double> out;
    for (const SplittingPoint& point : points) out.push_back(score(point));
    return out;
  };
}

double tail(double x) {
  return cdf(complement(boost::math::normal(), x));
}
double exceeded_with(double probability) {
  return quantile(complement(boost::math::normal(), probability));
}
double noise_of(std::uint64_t seed) {
  return sim::Stream(seed, "noise").normal();
}

/// Linear limit state: a standard normal number, of which the noise of all random streams contributes the fraction
/// `noise` of the variance.
PointScore linear(double noise) {
  return [noise](const SplittingPoint& point) {
    const double sum = std::accumulate(point.normals.begin(), point.normals.end(), 0.0);
    const double drawn = std::sqrt((1.0 - noise) / static_cast<double>(point.normals.size())) * sum;
    double random = 0.0;
    for (const std::uint64_t seed : point.seeds) random += noise > 0.0 ? noise_of(seed) : 0.0;
    return drawn + std::sqrt(noise / static_cast<double>(point.seeds.size())) * random;
  };
}

/// A random draw fails in one of two opposite regions.
double two_modes(const SplittingPoint& point) {
  return std::abs(point.normals[0]);
}

SplittingOptions options_for(double bound, std::size_t numbers, std::uint64_t seed, std::size_t population = 100) {
  SplittingOptions out;
  out.numbers = numbers;
  out.population = population;
  out.budget = kUnlimited;
  out.bound = bound;
  out.seed = seed;
  return out;
}

struct Misses {
  int below = 0, above = 0;  ///< intervals that are entirely below or above the true probability
  double mean = 0.0;         ///< mean estimate, relative to the true probability
  double error = 0.0;        ///< its standard error
};

Misses misses(const PointScore& score, double truth, SplittingOptions options, int repetitions = kRepetitions) {
  Misses out;
  double squares = 0.0;
  for (int i = 0; i < repetitions; ++i) {
    options.seed = static_cast<std::uint64_t>(i + 1);
    const Interval found = split(options, each(score)).probability;
    out.below += found.high < truth;
    out.above += found.low > truth;
    out.mean += found.value / truth / repetitions;
    squares += std::pow(found.value / truth, 2) / repetitions;
  }
  out.error = std::sqrt((squares - out.mean * out.mean) / repetitions);
  return out;
}

// With 95 % coverage, a side misses 5 of 200 repetitions on average. More than 13 misses on one side, or fewer than 2
// on both, have a probability below 1e-3.
constexpr int kSideMissesMax = 13, kMissesMin = 2;

struct Case {
  double probability, noise;
  std::size_t streams = 1;
};

class Coverage : public ::testing::TestWithParam<Case> {};

TEST_P(Coverage, OfTheIntervalIsTwoSided) {
  const auto [probability, noise, streams] = GetParam();
  SplittingOptions options = options_for(exceeded_with(probability), 10, 0);
  options.streams = streams;
  const Misses found = misses(linear(noise), probability, options);
  EXPECT_LE(found.below, kSideMissesMax);
  EXPECT_LE(found.above, kSideMissesMax);
  EXPECT_GE(found.below + found.above, kMissesMin) << "the interval is too wide";
  EXPECT_NEAR(found.mean, 1.0, 4.0 * found.error) << "the estimate is unbiased";
}

INSTANTIATE_TEST_SUITE_P(Splitting, Coverage,
                         ::testing::Values(Case{1e-2, 0.0}, Case{1e-2, 0.3}, Case{1e-3, 0.0}, Case{1e-3, 0.3},
                                           Case{1e-3, 0.7, 4}));

/// Negative control: a random walk does not leave the prior distribution invariant.
TEST(Splitting, CoverageOfABiasedMoveIsRejected) {
  SplittingOptions options = options_for(exceeded_with(1e-3), 10, 0);
  options.move = [](std::span<const double> normals, double step, const std::function<double()>& normal) {
    std::vector<double> out;
    for (const double x : normals) out.push_back(x + 0.3 * step * normal());
    return out;
  };
  EXPECT_GT(misses(linear(0.0), 1e-3, options).above, kSideMissesMax);
}

/// Negative control: a move that keeps its place gives copies, and the interval then becomes wide instead of wrong.
TEST(Splitting, WithoutMovesTheIntervalIsWide) {
  SplittingOptions options = options_for(exceeded_with(1e-2), 10, 0);
  options.move = [](std::span<const double> normals, double, const std::function<double()>&) {
    return std::vector<double>(normals.begin(), normals.end());
  };
  const Misses found = misses(linear(0.0), 1e-2, options);
  EXPECT_LE(found.below, kSideMissesMax);
  EXPECT_LE(found.above, kSideMissesMax);
  options.seed = 1;
  const Interval copies = split(options, each(linear(0.0))).probability;
  options.move = crank_nicolson;
  const Interval moved = split(options, each(linear(0.0))).probability;
  EXPECT_GT(copies.high / copies.low, 2.0 * moved.high / moved.low);
}

struct Rare {
  const char* name;
  PointScore score;
  double bound, truth;
  std::size_t numbers;
};

class RareEvent : public ::testing::TestWithParam<Rare> {};

TEST_P(RareEvent, HasItsProbability) {
  const Rare& rare = GetParam();
  const Misses found = misses(rare.score, rare.truth, options_for(rare.bound, rare.numbers, 0), 40);
  EXPECT_NEAR(found.mean, 1.0, 4.0 * found.error);
  EXPECT_LT(found.error, 0.25) << "or the mean shows nothing";
  EXPECT_LE(found.below + found.above, 8) << "of 40 intervals; exceeded with a probability below 1e-3";
}

INSTANTIATE_TEST_SUITE_P(Splitting, RareEvent,
                         ::testing::Values(Rare{"tail", linear(0.0), exceeded_with(1e-6), 1e-6, 1},
                                           Rare{"far tail", linear(0.0), exceeded_with(1e-9), 1e-9, 1},
                                           Rare{"linear", linear(0.0), exceeded_with(1e-9), 1e-9, 30},
                                           Rare{"two modes", two_modes, 5.0, 2.0 * tail(5.0), 3}));

TEST(Splitting, AnExhaustedBudgetGivesAnUpperLimit) {
  SplittingOptions options = options_for(exceeded_with(1e-6), 5, 3);
  options.budget = 4000;
  const SplittingResult found = split(options, each(linear(0.0)));
  EXPECT_FALSE(found.complete);
  EXPECT_LE(found.draws.size(), 4000u);
  EXPECT_LT(found.probability.low, 1e-6);
  EXPECT_GT(found.probability.high, 1e-6);
  EXPECT_LT(found.probability.high, 3.0 / 4000.0) << "the limit of as many plain draws";
}

/// If the budget is the population, the search is plain sampling.
TEST(Splitting, WithoutStepsTheIntervalIsThatOfPlainDraws) {
  SplittingOptions options = options_for(1.0, 2, 4);
  options.budget = options.population;
  const SplittingResult found = split(options, each(linear(0.0)));
  std::int64_t failures = 0;
  for (const ScoredPoint& draw : found.draws) failures += draw.score > 1.0;
  const Interval plain = share_interval(failures, 100);
  EXPECT_DOUBLE_EQ(found.probability.value, plain.value);
  EXPECT_DOUBLE_EQ(found.probability.low, plain.low);
  EXPECT_DOUBLE_EQ(found.probability.high, plain.high);
}

TEST(Splitting, ConstantScoresEndTheSearch) {
  const SplittingResult none = split(options_for(1.0, 2, 1), each([](const SplittingPoint&) { return 0.5; }));
  EXPECT_FALSE(none.complete);
  EXPECT_EQ(none.draws.size(), 100u);
  EXPECT_EQ(none.probability.low, 0.0);
  EXPECT_NEAR(none.probability.high, 1.0 - std::pow(0.025, 0.01), 1e-12) << "0 of 100";
  const SplittingResult all = split(options_for(1.0, 2, 1), each([](const SplittingPoint&) { return kUnbounded; }));
  EXPECT_TRUE(all.complete);
  EXPECT_EQ(all.probability.value, 1.0);
  EXPECT_NEAR(all.probability.low, std::pow(0.025, 0.01), 1e-12) << "100 of 100";
}

/// If only the seed matters, common ancestors become frequent. The interval must not exclude the truth more often.
TEST(Splitting, NoiseAloneWidensTheInterval) {
  const Misses found = misses(linear(1.0), 1e-2, options_for(exceeded_with(1e-2), 3, 0));
  EXPECT_LE(found.below, kSideMissesMax);
  EXPECT_LE(found.above, kSideMissesMax);
}

TEST(Splitting, MembersExceedTheLastLevel) {
  const SplittingResult found = split(options_for(exceeded_with(1e-4), 4, 9), each(linear(0.2)));
  ASSERT_TRUE(found.complete);
  ASSERT_FALSE(found.levels.empty());
  std::size_t failures = 0;
  for (const std::size_t member : found.members) {
    EXPECT_GT(found.draws.at(member).score, found.levels.back().score);
    failures += found.draws.at(member).score > exceeded_with(1e-4);
  }
  EXPECT_GE(failures, 75u);
  for (std::size_t i = 1; i < found.levels.size(); ++i) {
    EXPECT_GT(found.levels[i].score, found.levels[i - 1].score);
    EXPECT_LT(found.levels[i].probability.value, found.levels[i - 1].probability.value);
  }
}

TEST(Splitting, StopsWithoutTheUnfinishedStep) {
  std::size_t calls = 0;
  const ScorePoints score = [&](std::span<const SplittingPoint> points) {
    return ++calls > 3 ? std::vector<double>() : each(linear(0.0))(points);
  };
  const SplittingResult found = split(options_for(5.0, 3, 2), score);
  EXPECT_TRUE(found.stopped);
  EXPECT_TRUE(found.levels.empty());
  for (const std::size_t member : found.members) EXPECT_LT(member, 100u) << "a member of the first population";
}

std::string complaint(const SplittingOptions& options, double score = 0.0) {
  return test::complaint([&] { split(options, each([&](const SplittingPoint&) { return score; })); });
}

TEST(Splitting, RejectsInvalidOptions) {
  SplittingOptions options = options_for(1.0, 1, 1, 3);
  EXPECT_THAT(complaint(options), HasSubstr("the population is 3; it must be at least 4"));
  options = options_for(1.0, 1, 1);
  options.budget = 99;
  EXPECT_THAT(complaint(options),
              HasSubstr("the budget is 99 simulated runs; it must be at least the population, 100"));
  EXPECT_THAT(complaint(options_for(kUnbounded, 1, 1)), HasSubstr("must be finite"));
  EXPECT_THAT(complaint(options_for(1.0, 1, 1), std::nan("")), HasSubstr("is not a number"));
}

}  // namespace
}  // namespace tumble::scenarios
