// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/sample_size.hpp"

#include "scenarios/statistics/paired.hpp"
#include "sim/random/stream.hpp"
#include "tests/scenarios/statistics/samples.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

std::vector<double> shifted(sim::Stream& stream, std::size_t n, double shift) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(shift + stream.normal());
  return values;
}

// Noether's formula is applied by hand: for normal differences P(D + D' > 0) = Phi(shift sqrt 2)
TEST(PairsForSignedRank, FollowTheFormula) {
  sim::Stream stream(1, "test.noether");
  const double pairs = pairs_for_signed_rank(shifted(stream, 20000, 0.5), {});
  const double p = 0.5 * std::erfc(-0.5 * std::sqrt(2.0) / std::sqrt(2.0));
  const double expected = std::pow(1.959964 + 0.841621, 2) / (3.0 * std::pow(p - 0.5, 2));
  EXPECT_NEAR(pairs, expected, 0.05 * expected);
  EXPECT_GT(pairs_for_signed_rank(shifted(stream, 5000, 0.5), {0.001, 0.8}), 1.5 * pairs);
  EXPECT_GT(pairs_for_signed_rank(shifted(stream, 5000, 0.5), {0.05, 0.95}), 1.3 * pairs);
}

// the sums of pairs of the three differences are 1 + 2, 1 - 4 and 2 - 4; one of three is positive
TEST(PairsForSignedRank, CountsThePairsOfDifferences) {
  const double z = 1.959964 + 0.841621;
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{1, 2, -4}, {}),
            std::ceil(z * z / (3.0 * std::pow(1.0 / 3.0 - 0.5, 2))));
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{1, 2, -4, 0, 0, 0}, {}),
            std::ceil(2.0 * z * z / (3.0 * std::pow(1.0 / 3.0 - 0.5, 2))))
      << "draws on which nothing differs are needed besides";
}

TEST(PairsForSignedRank, DistinguishesAsOftenAsItStates) {
  for (const double shift : {0.3, 0.5}) {
    sim::Stream stream(2, "test.power");
    const auto pairs = static_cast<std::size_t>(pairs_for_signed_rank(shifted(stream, 4000, shift), {}));
    int told = 0;
    for (int k = 0; k < 1000; ++k) told += signed_rank_test(shifted(stream, pairs, shift)) < 0.05;
    // 1000 trials determine the power to 1.3 %
    EXPECT_GT(told, 760) << shift << " " << pairs;
    EXPECT_LT(told, 860) << shift << " " << pairs;
  }
}

TEST(PairsForSignedRank, NeverFewerThanTheTestNeeds) {
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{1, 2, 3, 4}, {0.05, 0.5}), 6.0);
  EXPECT_EQ(signed_rank_test(std::vector<double>{1, 2, 3, 4, 5, 6}), 0.03125);
  EXPECT_GT(signed_rank_test(std::vector<double>{1, 2, 3, 4, 5}), 0.05);
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{1, -1}, {}), kInfinity);
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{0.0, 0.0}, {}), kInfinity);
  EXPECT_EQ(pairs_for_signed_rank(std::vector<double>{kInfinity, -kInfinity}, {}), kInfinity);
  EXPECT_THROW(pairs_for_signed_rank(std::vector<double>{1.0, 2.0}, {0.0, 0.8}), BadInput);
  EXPECT_THROW(pairs_for_signed_rank(std::vector<double>{1.0, 2.0}, {0.05, 1.0}), BadInput);
}

// Connor's formula (1987) is applied by hand: psi = 0.3, delta = 0.1 gives (1.96 sqrt 0.3 + 0.8416 sqrt 0.29)^2 / 0.01
// = 233.1
TEST(PairsForFailures, FollowTheFormulaAndDistinguish) {
  EXPECT_EQ(pairs_for_failures(20, 10, 100, {}), 234.0);
  EXPECT_EQ(pairs_for_failures(10, 20, 100, {}), 234.0);
  EXPECT_EQ(pairs_for_failures(10, 10, 100, {}), kInfinity);
  EXPECT_EQ(pairs_for_failures(0, 0, 100, {}), kInfinity);
  EXPECT_THROW(pairs_for_failures(60, 60, 100, {}), BadInput);
  sim::Stream stream(4, "test.failures");
  int told = 0;
  for (int k = 0; k < 2000; ++k) {
    int first = 0, second = 0;
    for (int i = 0; i < 234; ++i) {
      const double u = stream.uniform();
      first += u < 0.2;
      second += u >= 0.2 && u < 0.3;
    }
    told += paired_failures_test(first, second) < 0.05;
  }
  // the exact test is conservative: its power is some 4 % below that of the normal test in the formula
  EXPECT_GT(told, 2000 * 0.72);
  EXPECT_LT(told, 2000 * 0.84);
}

}  // namespace
}  // namespace tumble::scenarios
