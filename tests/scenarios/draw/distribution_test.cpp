// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/distribution.hpp"

#include <boost/math/special_functions/erf.hpp>

#include "scenarios/draw/fixture_registry.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using Shape = Distribution::Shape;

constexpr int kDraws = 4000;

std::vector<double> draws(const Distribution& distribution) {
  std::vector<double> out;
  for (int seed = 0; seed < kDraws; ++seed) out.push_back(draw_number(distribution, seed, "world.slope_rad"));
  return out;
}

/// Returns the largest distance between the empirical distribution of `sample` and the expected one
/// (Kolmogorov-Smirnov).
double ks_distance(std::vector<double> sample, const std::function<double(double)>& below) {
  std::sort(sample.begin(), sample.end());
  double distance = 0.0;
  const auto n = static_cast<double>(sample.size());
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double expected = below(sample[i]);
    distance = std::max({distance, expected - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - expected});
  }
  return distance;
}

double normal_below(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

/// One sample in 1000 exceeds 1.95 / sqrt(n); the seeds are fixed, so the result of the test never varies.
const double kKsBound = 1.95 / std::sqrt(static_cast<double>(kDraws));

TEST(Distribution, DrawsFollowTheStatedLaw) {
  EXPECT_LT(ks_distance(draws({Shape::uniform, {2.0, 5.0}}), [](double x) { return (x - 2.0) / 3.0; }), kKsBound);
  EXPECT_LT(ks_distance(draws({Shape::normal, {1.0, 2.0}}), [](double x) { return normal_below((x - 1.0) / 2.0); }),
            kKsBound);
  EXPECT_LT(
      ks_distance(draws({Shape::log_uniform, {0.01, 100.0}}), [](double x) { return (std::log10(x) + 2.0) / 4.0; }),
      kKsBound);
  const double low = normal_below(-0.5);
  const double kept = normal_below(1.0) - low;
  EXPECT_LT(ks_distance(draws({Shape::normal, {1.0, 2.0, 0.0, 3.0}}),
                        [&](double x) { return (normal_below((x - 1.0) / 2.0) - low) / kept; }),
            kKsBound);
}

TEST(Distribution, TheLawCheckRefusesAWrongLaw) {
  EXPECT_GT(ks_distance(draws({Shape::uniform, {2.0, 5.0}}), [](double x) { return (x - 2.0) / 3.2; }), kKsBound);
  EXPECT_GT(ks_distance(draws({Shape::normal, {1.0, 2.0, 0.0, 3.0}}), [](double x) { return x / 3.0; }), kKsBound);
}

/// The values of equally spaced probabilities have the same distribution as the values of random seeds.
TEST(Distribution, ANormalScoreGivesTheSameLawAsASeed) {
  const auto at_scores = [](const Distribution& distribution) {
    std::vector<double> out;
    for (int i = 0; i < kDraws; ++i)
      out.push_back(number_at(distribution, -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * (i + 0.5) / kDraws)));
    return out;
  };
  for (const Distribution& d :
       {Distribution{Shape::uniform, {2.0, 5.0}}, Distribution{Shape::log_uniform, {0.01, 100.0}},
        Distribution{Shape::normal, {1.0, 2.0}}, Distribution{Shape::normal, {0.0, 11.0, 11.3, 30.0}},
        Distribution{Shape::choice, {30.0, 40.0, 50.0}}}) {
    const std::vector<double> scored = at_scores(d);
    std::vector<double> drawn = draws(d);
    EXPECT_TRUE(std::is_sorted(scored.begin(), scored.end()));
    std::sort(drawn.begin(), drawn.end());
    const auto below_scored = [&](double x) {
      return static_cast<double>(std::upper_bound(scored.begin(), scored.end(), x) - scored.begin()) / kDraws;
    };
    const auto below_drawn = [&](double x) {
      return static_cast<double>(std::upper_bound(drawn.begin(), drawn.end(), x) - drawn.begin()) / kDraws;
    };
    double distance = 0.0;
    for (const double x : scored) distance = std::max(distance, std::abs(below_scored(x) - below_drawn(x)));
    EXPECT_LT(distance, 1.95 / std::sqrt(kDraws)) << to_string(d.shape) << ": exceeded with probability 1e-3";
  }
}

TEST(Distribution, AnExtremeNormalScoreStaysWithinTheEnds) {
  for (const double score : {-40.0, -9.0, 9.0, 40.0}) {
    const double value = number_at({Shape::normal, {0.0, 11.0, 11.3, 30.0}}, score);
    EXPECT_TRUE(value >= 11.3 && value <= 30.0) << score;
    EXPECT_NEAR(number_at({Shape::normal, {0.0, 1.0}}, score), score, 0.0);
    EXPECT_EQ(number_at({Shape::choice, {1.0, 2.0}}, score), score < 0.0 ? 1.0 : 2.0);
  }
  EXPECT_EQ(number_at({Shape::constant, {7.0}}, 3.0), 7.0);
  EXPECT_THROW(number_at({Shape::uniform, {3.0, 2.0}}, 0.0), BadInput);
}

TEST(Distribution, StaysWithinItsEnds) {
  for (const Distribution& d : {Distribution{Shape::uniform, {0.1, 0.3}}, Distribution{Shape::log_uniform, {0.1, 0.3}},
                                Distribution{Shape::normal, {0.2, 1.0, 0.1, 0.3}}}) {
    const std::vector<double> sample = draws(d);
    EXPECT_GE(*std::min_element(sample.begin(), sample.end()), 0.1) << to_string(d.shape);
    EXPECT_LE(*std::max_element(sample.begin(), sample.end()), 0.3) << to_string(d.shape);
  }
}

TEST(Distribution, ChoiceTakesEachValueAsOften) {
  const std::vector<double> sample = draws({Shape::choice, {1.0, 2.0, 4.0, 8.0}});
  for (const double value : {1.0, 2.0, 4.0, 8.0}) {
    // the count is binomial with mean 1000 and standard deviation 27; the bound is four of them
    EXPECT_NEAR(static_cast<double>(std::count(sample.begin(), sample.end(), value)), 1000.0, 110.0) << value;
  }
}

TEST(Distribution, ConstantAndDegenerateGiveTheNumber) {
  EXPECT_EQ(draw_number({Shape::constant, {0.1}}, 7, "a"), 0.1);
  EXPECT_EQ(draw_number({Shape::uniform, {0.1, 0.1}}, 7, "a"), 0.1);
  EXPECT_EQ(draw_number({Shape::log_uniform, {0.1, 0.1}}, 7, "a"), 0.1);
  EXPECT_EQ(draw_number({Shape::normal, {0.1, 0.0}}, 7, "a"), 0.1);
}

TEST(Distribution, BelongsToSeedAndPlace) {
  const Distribution d{Shape::uniform, {0.0, 1.0}};
  EXPECT_EQ(draw_number(d, 7, "world.slope_rad"), draw_number(d, 7, "world.slope_rad"));
  EXPECT_NE(draw_number(d, 7, "world.slope_rad"), draw_number(d, 8, "world.slope_rad"));
  EXPECT_NE(draw_number(d, 7, "world.slope_rad"), draw_number(d, 7, "world.relief_m"));
}

TEST(Distribution, ImpossibleOnesAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Distribution& d :
       {Distribution{Shape::constant, {}}, Distribution{Shape::constant, {nan}},
        Distribution{Shape::uniform, {2.0, 1.0}}, Distribution{Shape::uniform, {0.0, infinity}},
        Distribution{Shape::normal, {0.0, -1.0}}, Distribution{Shape::normal, {0.0, nan}},
        Distribution{Shape::normal, {0.0, 1.0, 5.0, 6.0}}, Distribution{Shape::normal, {0.0, 1.0, 1.0, 0.0}},
        Distribution{Shape::log_uniform, {0.0, 1.0}}, Distribution{Shape::log_uniform, {-1.0, 1.0}},
        Distribution{Shape::choice, {}}}) {
    EXPECT_NE(find_problem(d), "") << to_string(d.shape);
    EXPECT_THROW(draw_number(d, 1, "a"), BadInput) << to_string(d.shape);
  }
}

}  // namespace
}  // namespace tumble::scenarios
