// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/metric.hpp"

#include "scenarios/scoring/score.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(MetricInfo, TwoSidedMetricsHaveATargetAndTheOthersNone) {
  std::map<Sense, std::size_t> count;
  for (const Metric& metric : metrics()) {
    ++count[metric.info.sense];
    EXPECT_EQ(metric.info.sense == Sense::two_sided, std::isfinite(metric.info.target)) << metric.info.name;
    const bool consistency = metric.info.name.find("nees") != std::string::npos ||
                             metric.info.name.find("coverage_3sigma") != std::string::npos;
    const bool offset = metric.info.unit == Unit::time_offset;
    EXPECT_EQ(metric.info.sense == Sense::two_sided, consistency || offset) << metric.info.name;
    if (metric.info.place != Place::detail) {
      EXPECT_NE(metric.info.sense, Sense::none) << metric.info.name;
    }
  }
  for (const Sense sense : {Sense::lower, Sense::higher, Sense::two_sided, Sense::none}) EXPECT_GE(count[sense], 2u);
}

// a ratio says nothing about values that may be 0 or below; a difference needs a margin in its unit, which gate.hpp has
// for two units
TEST(MetricInfo, WhatTheGateHoldsIsComparedByWhatItsUnitHas) {
  std::map<Compared, std::size_t> count;
  for (const Metric& metric : metrics()) {
    const MetricInfo& info = metric.info;
    ++count[info.compared];
    if (info.compared == Compared::by_difference) {
      EXPECT_TRUE(info.unit == Unit::share || info.unit == Unit::time_offset) << info.name;
    } else if (info.place != Place::detail) {
      EXPECT_FALSE(info.target == 0.0 || info.sense == Sense::higher) << info.name;
    }
  }
  EXPECT_GE(count[Compared::by_difference], 10u);
  EXPECT_GE(count[Compared::by_ratio], 20u);
}

TEST(MetricInfo, EveryKindHasHeadlinesAndTheGateHoldsThem) {
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    const std::vector<std::string> headlines = headline_metrics(kind), held = held_metrics(kind);
    ASSERT_FALSE(headlines.empty()) << to_string(kind);
    for (const std::string& name : headlines) {
      EXPECT_NE(std::find(held.begin(), held.end(), name), held.end()) << name;
    }
  }
  EXPECT_EQ(headline_metrics(Kind::rate).front(), "rate_error_clipped_median_rad_s");
}

// a name has one meaning: kinds that share a metric share its description
TEST(MetricInfo, IsFoundByName) {
  for (const Metric& metric : metrics()) {
    const MetricInfo& info = metric_info(metric.info.name);
    EXPECT_EQ(info.doc, metric.info.doc) << metric.info.name;
    EXPECT_EQ(info.unit, metric.info.unit) << metric.info.name;
  }
  EXPECT_EQ(metric_info("rate_error_p99_rad_s@clip_depth_rad_s:3:5").unit, Unit::rad_s);  // bins of another version
  EXPECT_EQ(metric_info("estimate_cpu_s").sense, Sense::none);
  EXPECT_EQ(metric_info("motion_clipped_share").unit, Unit::share);
  EXPECT_EQ(metric_info("unheard_of").sense, Sense::none);
  EXPECT_EQ(metric_info("unheard_of").name, "");
}

TEST(MetricInfo, SharesAreShownInPercentAllOfThem) {
  for (const char* name : {"map_overlap", "map_overlap_0_10", "rate_coverage_3sigma_flight", "slip_recall"}) {
    EXPECT_EQ(style_of(metric_info(name).unit).unit, "%") << name;
  }
  EXPECT_EQ(style_of(metric_info("pose_nees").unit).unit, "");
  EXPECT_EQ(style_of(metric_info("pose_time_offset_s").unit).unit, "ms");
  EXPECT_EQ(style_of(metric_info("estimate_cpu_s").unit).unit, "s");
}

TEST(MetricInfo, BetterIsLowerHigherOrNearerToTheTarget) {
  EXPECT_TRUE(is_better(metric_info("ate_m"), 0.1, 0.2));
  EXPECT_FALSE(is_better(metric_info("ate_m"), 0.2, 0.1));
  EXPECT_TRUE(is_better(metric_info("map_overlap"), 0.2, 0.1));
  const MetricInfo& nees = metric_info("pose_nees");
  EXPECT_TRUE(is_better(nees, 1.2, 0.3)) << "the most over-cautious covariance is not the best";
  EXPECT_TRUE(is_better(nees, 0.8, 2.0));
  EXPECT_FALSE(is_better(nees, 0.01, 1.5));
  EXPECT_TRUE(is_better(metric_info("pose_time_offset_s"), -1e-4, 2e-4)) << "nearer to 0";
  EXPECT_FALSE(is_better(metric_info("pose_time_offset_s"), -3e-4, 2e-4));
  EXPECT_FALSE(is_better(metric_info("estimate_cpu_s"), 1.0, 2.0));
  EXPECT_FALSE(is_better(metric_info("ate_m"), std::nan(""), 2.0));
  EXPECT_EQ(worst_value(metric_info("ate_m")), kInfinity);
  EXPECT_EQ(worst_value(metric_info("map_overlap")), -kInfinity);
  EXPECT_TRUE(std::isnan(worst_value(nees)));
}

TEST(OutcomeStatus, NamesReadBack) {
  for (const OutcomeStatus status : outcome_statuses()) EXPECT_EQ(outcome_status_named(to_string(status)), status);
  EXPECT_EQ(outcome_status_named("OK"), std::nullopt);
}

}  // namespace
}  // namespace tumble::scenarios
