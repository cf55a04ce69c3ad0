// SPDX-License-Identifier: BSD-3-Clause
// The test checks what a page of the benchmark says of results with known medians.
#include "scenarios/bench/bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/complaint.hpp"
#include "tests/scenarios/bench/some_result.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;
using testing::kError;
using testing::some_result;

Suite small() {
  Suite suite;
  suite.name = "small";
  suite.timeout_s = 60;
  suite.classes = {{"mild", {{"hill", 1}}}, {"wild", {{"hill", 18446744073709551615u}, {"hill", 3}}}};
  return suite;
}

TEST(Bench, AFailureRanksAsTheWorst) {
  const std::vector<BenchResult> all = {some_result("mine", {0.1, 0.2, -1.0, 0.4})};
  const BenchCell wild = bench_cell(all[0], kError, "wild", all);
  EXPECT_EQ(wild.draws, 3u);
  EXPECT_EQ(wild.lost, 1u);
  EXPECT_EQ(wild.median, 0.4);
  EXPECT_EQ(bench_cell(all[0], kError, "mild", all).median, 0.1);
  EXPECT_EQ(bench_cell(all[0], kError, "", all).draws, 4u);
  const std::vector<BenchResult> lost = {some_result("mine", {-1.0, -1.0, 0.3})};
  EXPECT_TRUE(std::isinf(bench_cell(lost[0], kError, "", lost).median));
}

TEST(Bench, ADrawWithNothingToScoreDoesNotCountForAnybody) {
  const std::vector<BenchResult> all = {some_result("mine", {-1.0, 0.2, 0.3}), some_result("raw", {0.0, 0.5, 0.1}, 0)};
  EXPECT_EQ(bench_cell(all[0], kError, "mild", all).draws, 0u) << "it crashed where another had nothing to score";
  EXPECT_TRUE(std::isnan(bench_cell(all[1], kError, "mild", all).median));
  EXPECT_EQ(bench_cell(all[0], kError, "mild", {}).lost, 1u) << "alone nobody can know";
  const BenchWins wins = bench_wins(all[0], all[1], kError, all);
  EXPECT_EQ(wins.draws, 2u);
  EXPECT_EQ(wins.better, 1u);
}

TEST(Bench, ResultsOfAnotherSuiteAreRefused) {
  const auto refusal = [](const BenchResult& result, const Suite& suite) -> std::string {
    return test::complaint([&] { require_of_suite(result, suite); });
  };
  BenchResult result = some_result("mine", {0.1, 0.2, 0.3});
  result.suite_digest = bench_suite_digest(small());
  EXPECT_EQ(refusal(result, small()), "");
  Suite other = small();
  other.classes[1].draws[1].second = 4;
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  other = small();
  other.classes[0].name = "soft";
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  other = small();
  other.timeout_s = 61;
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  result.draws.pop_back();
  EXPECT_THAT(refusal(result, small()), HasSubstr("contains 2 simulated runs"));
}

TEST(Bench, ResultsOfAnotherSimulationAreReported) {
  const BenchResult a = some_result("a", {0.1, 0.2, 0.3});
  BenchResult b = some_result("b", {0.1, 0.2, 0.3});
  EXPECT_EQ(other_recording(a, b), "");
  b.draws[2].recording = "";  // a draw whose process crashed
  EXPECT_EQ(other_recording(a, b), "");
  b.draws[2].recording = "another";
  EXPECT_EQ(other_recording(a, b), "hill 3");
}

}  // namespace
}  // namespace tumble::scenarios
