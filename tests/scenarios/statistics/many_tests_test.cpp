// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/paired.hpp"

#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::DoubleNear;

// the worked example of Holm's steps gives 4 x 0.01, 3 x 0.02, 2 x 0.03, which may not fall below the value before, and
// 0.04
TEST(Holm, StepsDown) {
  EXPECT_THAT(
      holm(std::vector<double>{0.02, 0.04, 0.01, 0.03}),
      ElementsAre(DoubleNear(0.06, 1e-15), DoubleNear(0.06, 1e-15), DoubleNear(0.04, 1e-15), DoubleNear(0.06, 1e-15)));
  EXPECT_THAT(holm(std::vector<double>{0.4, 0.9}), ElementsAre(0.8, 0.9));
  EXPECT_THAT(holm(std::vector<double>{0.6, 0.9}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(holm({}).empty());
}

TEST(Holm, WhatIsNoTestCountsForNothing) {
  const std::vector<double> corrected = holm(std::vector<double>{0.01, std::nan(""), 0.02});
  EXPECT_DOUBLE_EQ(corrected[0], 0.02);
  EXPECT_TRUE(std::isnan(corrected[1]));
  EXPECT_DOUBLE_EQ(corrected[2], 0.02);
}

// all ten hypotheses are true: some hypothesis is rejected in 5 % of the tables, and without the correction in 40 %
TEST(Holm, KeepsTheRiskOfTheWholeTable) {
  sim::Stream stream(1, "test.holm");
  int any = 0, any_uncorrected = 0;
  for (int table = 0; table < 4000; ++table) {
    std::vector<double> chances;
    for (int i = 0; i < 10; ++i) chances.push_back(stream.uniform());
    any_uncorrected += *std::min_element(chances.begin(), chances.end()) < 0.05;
    const std::vector<double> corrected = holm(chances);
    any += *std::min_element(corrected.begin(), corrected.end()) < 0.05;
  }
  EXPECT_GT(any, 4000 * 0.038);
  EXPECT_LT(any, 4000 * 0.060);
  EXPECT_GT(any_uncorrected, 4000 * 0.35) << "negative control";
}

}  // namespace
}  // namespace tumble::scenarios
