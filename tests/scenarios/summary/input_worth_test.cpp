// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/input_worth.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr const char* kMetric = "translation_error_end_m";

TriageRow row(const std::string& input, double error_m, bool fails, OutcomeStatus status = OutcomeStatus::ok) {
  TriageRow out{input, "what " + input + " is", {}, fails};
  out.outcome.status = status;
  out.outcome.scores = {{kMetric, error_m}};
  return out;
}

/// Returns twenty draws whose error is k: "good" removes 1 m from each and cures all, "half" cures every second one and
/// changes no error, "harm" makes the even draws fail and adds 2 m.
std::vector<DrawTriage> draws(const std::string& scenario, int count = 20) {
  std::vector<DrawTriage> out;
  for (int k = 1; k <= count; ++k) {
    const bool fails = k % 2 == 1;
    const double error_m = 10.0 + k;
    out.push_back({{scenario, static_cast<std::uint64_t>(k)},
                   {row("none", error_m, fails), row("harm", error_m + 2.0, true),
                    row("half", error_m, fails && k % 4 == 1), row("good", error_m - 1.0, false)},
                   ""});
  }
  return out;
}

TEST(InputWorth, IsWhatTheDrawsWereMadeOf) {
  const std::vector<InputWorth> worths = worth_of_inputs(draws("hill"), kMetric);
  ASSERT_EQ(worths.size(), 3u);
  const InputWorth &good = worths[0], &half = worths[1], &harm = worths[2];
  EXPECT_EQ(good.input, "good");
  EXPECT_EQ(good.scenario, "hill");
  EXPECT_EQ(good.doc, "what good is");
  EXPECT_EQ(good.draws, 20);
  EXPECT_EQ(good.failed, 10);
  EXPECT_EQ(good.cured, 10);
  EXPECT_EQ(good.broken, 0);
  EXPECT_DOUBLE_EQ(good.cured_share.value, 1.0);
  EXPECT_NEAR(good.cured_share.low, std::pow(0.025, 0.1), 1e-9) << "Clopper and Pearson of 10 in 10";
  EXPECT_DOUBLE_EQ(good.improvement.value, 1.0);
  EXPECT_DOUBLE_EQ(good.improvement.low, 1.0);
  EXPECT_EQ(good.better, 20);
  EXPECT_NEAR(good.chance, std::pow(0.5, 19), 1e-12) << "twice the one sign pattern of 2^20";

  EXPECT_EQ(half.input, "half");
  EXPECT_EQ(half.cured, 5);
  EXPECT_DOUBLE_EQ(half.cured_share.value, 0.5);
  EXPECT_DOUBLE_EQ(half.improvement.value, 0.0);
  EXPECT_DOUBLE_EQ(half.chance, 1.0);

  EXPECT_EQ(harm.broken, 10);
  EXPECT_EQ(harm.cured, 0);
  EXPECT_DOUBLE_EQ(harm.improvement.value, -2.0);
  EXPECT_EQ(harm.worse, 20);
  for (const InputWorth& worth : worths) EXPECT_GE(worth.corrected, worth.chance);
}

TEST(InputWorth, OfSeveralScenariosAlsoAllTogether) {
  std::vector<DrawTriage> all = draws("hill");
  for (DrawTriage& draw : draws("cliff", 8)) all.push_back(std::move(draw));
  const std::vector<InputWorth> worths = worth_of_inputs(all, kMetric);
  ASSERT_EQ(worths.size(), 9u);
  EXPECT_EQ(worths[0].scenario, "cliff");
  EXPECT_EQ(worths[3].scenario, "hill");
  EXPECT_EQ(worths[6].scenario, "");
  EXPECT_EQ(worths[6].draws, 28);
  EXPECT_EQ(worths[6].cured, 14);
}

TEST(InputWorth, ARunThatIsNotOkRanksAsTheWorst) {
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<DrawTriage> all;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    all.push_back({{"hill", seed},
                   {row("none", 1.0, true, OutcomeStatus::diverged), row("cures", 0.5, false),
                    row("not", 1.0, true, OutcomeStatus::failed)},
                   ""});
  }
  const std::vector<InputWorth> worths = worth_of_inputs(all, kMetric);
  EXPECT_EQ(worths[0].input, "cures");
  EXPECT_EQ(worths[0].improvement.value, infinite);
  EXPECT_EQ(worths[1].improvement.value, 0.0) << "two that failed are equal";
}

TEST(InputWorth, DrawsWithoutRowsAndInputsWithoutMetricSayNothing) {
  std::vector<DrawTriage> all = draws("hill", 2);
  all.push_back({{"hill", 3}, {}, "cannot be simulated"});
  for (DrawTriage& draw : all) {
    for (TriageRow& each : draw.rows) {
      if (each.input == "half") each.outcome.scores.clear();
    }
  }
  for (const InputWorth& worth : worth_of_inputs(all, kMetric)) {
    EXPECT_EQ(worth.draws, 2) << worth.input;
    EXPECT_EQ(std::isnan(worth.improvement.value), worth.input == "half") << worth.input;
  }
  EXPECT_TRUE(worth_of_inputs({}, kMetric).empty());
}

}  // namespace
}  // namespace tumble::scenarios
