// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/score_html.hpp"

#include "tests/testing.hpp"
#include "tests/tools/results_fixture.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::MethodSummary;
using scenarios::metric_style;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::summarize;
using scenarios::Summary;

constexpr const char* kError = "rate_error_clipped_median_rad_s";

class SummaryTest : public testing::ResultsFixture {
 protected:
  void store(std::uint64_t seed, Kind kind, const std::string& method, scenarios::OutcomeStatus status,
             std::vector<scenarios::Score> scores) {
    results().store(testing::hill_outcome(seed, kind, method, status, std::move(scores)));
  }
};

TEST_F(SummaryTest, PairsDrawByDrawWithTheBaseline) {
  // saave is better on 2 of the 4 draws: draw 4 failed and ranks behind every number, whatever its score
  store(2, Kind::rate, "saave", scenarios::OutcomeStatus::ok, {{kError, 0.5}});
  store(1, Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{kError, 2.0}});
  store(2, Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{kError, 3.0}});
  store(3, Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{kError, 4.0}});
  store(4, Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{kError, 5.0}});
  store(3, Kind::rate, "saave", scenarios::OutcomeStatus::ok, {{kError, 9.0}});
  store(1, Kind::rate, "saave", scenarios::OutcomeStatus::ok, {{kError, 1.0}});
  store(4, Kind::rate, "saave", scenarios::OutcomeStatus::diverged, {{kError, 0.001}});

  const Summary summary = summarize(results());
  ASSERT_EQ(summary.sections.size(), 1u);
  const Section& section = summary.sections.front();
  EXPECT_EQ(section.baseline, "raw");
  const MethodSummary* saave = section.find("saave");
  ASSERT_NE(saave, nullptr);
  EXPECT_EQ(saave->outcomes, 4);
  EXPECT_EQ(saave->not_ok, 1);
  const MetricSummary* metric = saave->find(kError);
  ASSERT_NE(metric, nullptr);
  EXPECT_THAT(metric->seeds, ElementsAre(1, 2, 3)) << "by rising seed, without the one that diverged";
  EXPECT_THAT(metric->values, ElementsAre(1.0, 0.5, 9.0));
  EXPECT_THAT(metric->failed, ElementsAre(4));
  EXPECT_EQ(metric->centre.value, 5.0) << "median of 0.5, 1, 9 and a failure";
  EXPECT_TRUE(std::isinf(metric->quantile_95)) << "one failure in four reaches the worst 5 %";
  EXPECT_EQ(metric->wins.count, 2);
  EXPECT_EQ(metric->wins.pairs, 4);
  EXPECT_EQ(section.find("raw")->find(kError)->wins.pairs, 0) << "the baseline is not paired with itself";
  EXPECT_EQ(summary.draws.at("hill"), 4);
}

TEST_F(SummaryTest, AMedianIsInfiniteOnceMostRunsFail) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    store(seed, Kind::slam, "icp_raw", seed == 1 ? scenarios::OutcomeStatus::ok : scenarios::OutcomeStatus::crashed,
          {{"map_overlap", 0.5}, {"ate_m", 1.0}});
    store(seed, Kind::slam, "icp", scenarios::OutcomeStatus::ok, {{"map_overlap", 0.4}, {"ate_m", 2.0}});
  }
  const Summary summary = summarize(results());
  const MethodSummary* raw = summary.sections.front().find("icp_raw");
  EXPECT_EQ(raw->find("ate_m")->centre.value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(raw->find("map_overlap")->centre.value, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(summary.sections.front().find("icp")->find("ate_m")->wins.count, 2)
      << "beats what failed, loses to what did not";
}

TEST_F(SummaryTest, HigherIsBetterForOverlapAndNearerToItsTargetForCoverageOfAnInterval) {
  for (const std::uint64_t seed : {1u, 2u}) {
    store(seed, Kind::slam, "icp_raw", scenarios::OutcomeStatus::ok,
          {{"map_overlap", 0.5}, {"rate_coverage_3sigma", 0.5}});
    store(seed, Kind::slam, "icp", scenarios::OutcomeStatus::ok, {{"map_overlap", 0.9}, {"rate_coverage_3sigma", 0.9}});
  }
  const Summary summary = summarize(results());
  const MethodSummary* icp = summary.sections.front().find("icp");
  EXPECT_EQ(summary.sections.front().baseline, "icp_raw");
  EXPECT_EQ(icp->find("map_overlap")->wins.count, 2);
  EXPECT_EQ(icp->find("rate_coverage_3sigma")->wins.count, 2) << "0.9 is nearer to 0.9973";
}

TEST_F(SummaryTest, VerdictsGiveTheirShareAndNotTheirMedian) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    store(seed, Kind::slam, "icp", scenarios::OutcomeStatus::ok, {{"map_failed", seed == 3 ? 1.0 : 0.0}});
  const auto summary = summarize(results());
  const MetricSummary* metric = summary.sections.front().find("icp")->find("map_failed");
  ASSERT_NE(metric, nullptr);
  EXPECT_NEAR(metric->centre.value, 0.1, 1e-12);
  // Clopper and Pearson's interval for 1 of 10 is [0.0025, 0.4450] (their table)
  EXPECT_NEAR(metric->centre.low, 0.0025, 1e-4);
  EXPECT_NEAR(metric->centre.high, 0.4450, 1e-4);
}

TEST_F(SummaryTest, RejectedDrawsAreCountedApart) {
  store(1, Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{kError, 1.0}});
  results().store(scenarios::RejectedDraw{"hill", 2, "left the world"});
  const Summary summary = summarize(results());
  EXPECT_EQ(summary.draws.at("hill"), 1);
  EXPECT_EQ(summary.rejected.at("hill"), 1);
}

TEST_F(SummaryTest, OfAnEmptyDatabaseIsEmpty) {
  const Summary summary = summarize(results());
  EXPECT_TRUE(summary.sections.empty());
  EXPECT_TRUE(summary.scenarios.empty());
}

TEST(MetricStyle, FollowsTheUnitInTheName) {
  EXPECT_EQ(metric_style("rate_error_clipped_median_rad_s").unit, "rad/s");
  EXPECT_EQ(metric_style("rotation_error_end_rad").unit, "°");
  EXPECT_NEAR(metric_style("rotation_error_end_rad").factor, 57.29577951308232, 1e-12);
  EXPECT_EQ(metric_style("sweep_jump_m_s").unit, "m/s");
  EXPECT_EQ(metric_style("translation_error_end_m").unit, "m");
  EXPECT_EQ(metric_style("position_end_error_share").unit, "%");
  EXPECT_EQ(metric_style("map_overlap").factor, 100.0);
  EXPECT_EQ(metric_style("estimate_cpu_s").unit, "s");
  EXPECT_EQ(metric_style("estimate_peak_mib").unit, "MiB");
  EXPECT_EQ(metric_style("unheard_of").unit, "");
}

TEST(StyledValue, HasThreeDigitsInTheUnitForPeople) {
  EXPECT_EQ(styled_value("map_overlap", 0.9214, true), "92.1 %");
  EXPECT_EQ(styled_value("rotation_error_end_rad", 0.1, true), "5.73 °");
  EXPECT_EQ(styled_value("ate_m", 0.0, true), "0 m");
  EXPECT_EQ(styled_value("ate_m", 1234.5, false), "1234");
  EXPECT_EQ(styled_value("ate_m", std::nan(""), false), "–");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(styled_interval("ate_m", {1.0, -infinity, infinity}), "[–]");
  EXPECT_EQ(styled_interval("ate_m", {1.0, 0.5, 2.0}), "[0.500, 2.00]");
}

}  // namespace
}  // namespace tumble::tools
