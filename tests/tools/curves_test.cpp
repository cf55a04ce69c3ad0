// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/curves.hpp"

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tests/tools/results_fixture.hpp"
#include "tools/report/page.hpp"

namespace tumble::tools {
namespace {

using scenarios::find_curves;
using scenarios::Kind;
using scenarios::Setting;

constexpr const char* kMedian = "rate_error_clipped_median_rad_s";
constexpr const char* kOffset = "given.time_offset_s";

class CurvesTest : public testing::ResultsFixture {
 protected:
  void store(std::uint64_t seed, Kind kind, const std::string& method, const Setting& setting,
             std::vector<scenarios::Score> scores, scenarios::OutcomeStatus status = scenarios::OutcomeStatus::ok) {
    scenarios::Outcome outcome = testing::hill_outcome(seed, kind, method, status, std::move(scores));
    outcome.setting = setting;
    results().store(outcome);
  }
  const Curve* find(const std::vector<Curve>& curves, const std::string& axis, const std::string& metric) const {
    for (const Curve& curve : curves) {
      if (curve.axis == axis && curve.metric == metric) return &curve;
    }
    return nullptr;
  }
};

TEST_F(CurvesTest, AreDrawnPerMethodOverTheValuesThatWereSet) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto error = static_cast<double>(seed);
    store(seed, Kind::rate, "raw", {}, {{kMedian, 77.0}});  // unchanged value: not a point of the curve
    for (const double value : {0.0, 0.005, 0.01}) {
      store(seed, Kind::rate, "tumble", {kOffset, value}, {{kMedian, error * (1.0 + 100.0 * value)}});
      store(seed, Kind::rate, "raw", {kOffset, value}, {{kMedian, 10.0 * error}});
    }
  }
  const std::vector<Curve> curves = find_curves(results());
  ASSERT_EQ(curves.size(), 1u) << "the metric that no run has makes no curve";
  const Curve& curve = curves.front();
  EXPECT_EQ(curve.axis, kOffset);
  EXPECT_EQ(curve.metric, kMedian);
  ASSERT_EQ(curve.lines.size(), 2u);
  EXPECT_EQ(curve.lines[0].method, "raw") << "in the order of the registry";
  const std::vector<CurvePoint>& points = curve.lines[1].points;
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[2].x, 0.01);
  EXPECT_EQ(points[2].draws, 5);
  EXPECT_NEAR(points[2].median, 6.0, 1e-12);
  EXPECT_NEAR(points[2].quantile_25, 4.0, 1e-12);
  EXPECT_NEAR(points[2].quantile_75, 8.0, 1e-12);
  EXPECT_NEAR(points[2].worst_5, 9.6, 1e-12) << "type 7: 0.8 of the way from 8 to 10";
  EXPECT_EQ(points[2].failed, 0);
  // Clopper and Pearson's limit for 0 of 5 is 1 - 0.025^(1/5)
  EXPECT_NEAR(points[2].failed_share.high, 1.0 - std::pow(0.025, 0.2), 1e-9);
}

TEST_F(CurvesTest, AFailureRanksAsTheWorstAndAFailedMapCountsAsOne) {
  const Setting clean{kOffset, 0.0}, late{kOffset, 0.01};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    store(seed, Kind::slam, "icp_raw", clean,
          {{"translation_error_end_m", 1.0}, {"map_failed", seed == 1 ? 1.0 : 0.0}, {"health_wrong", 1.0}});
    store(seed, Kind::slam, "icp_raw", late, {{"translation_error_end_m", 2.0}},
          seed <= 3 ? scenarios::OutcomeStatus::diverged : scenarios::OutcomeStatus::ok);
    store(seed, Kind::slam, "tumble", late, {{"translation_error_end_m", 0.1}});
  }
  const std::vector<Curve> curves = find_curves(results());
  const Curve* curve = find(curves, kOffset, "translation_error_end_m");
  ASSERT_NE(curve, nullptr);
  const std::vector<CurvePoint>& raw = curve->lines[0].points;
  ASSERT_EQ(raw.size(), 2u);
  EXPECT_EQ(raw[0].failed, 1);
  EXPECT_EQ(raw[0].median, 1.0);
  EXPECT_EQ(raw[1].failed, 3);
  EXPECT_TRUE(std::isinf(raw[1].median)) << "three of four failed";
  // the figure has a gap there and shows the share of failures below
  const Figure figure = curve_figure(*curve);
  bool gap = false, failures = false;
  for (const nlohmann::json& trace : nlohmann::json::parse(figure.traces)) {
    if (trace["name"] != "icp_raw") continue;
    if (trace.value("yaxis", "y") == "y2") {
      failures = true;
      EXPECT_EQ(trace["y"], nlohmann::json({25.0, 75.0}));
    } else if (trace["mode"] == "lines+markers") {
      gap = trace["y"][1].is_null() && trace["y"][0] == 1.0;
      EXPECT_EQ(trace["x"], nlohmann::json({0.0, 0.01}));
    }
  }
  EXPECT_TRUE(gap);
  EXPECT_TRUE(failures);
}

TEST_F(CurvesTest, OfBinnedMetricsStandAtTheBinsAndInNoTable) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    store(seed, Kind::rate, "raw", {},
          {{kMedian, 1.0},
           {"rate_error_median_rad_s@clip_length_s:0.105:0.205", 2.0},
           {"rate_error_median_rad_s@clip_length_s:0.025:0.055", 1.0},
           {"rate_error_median_rad_s@clip_length_s:0.405:inf", 4.0}});
  }
  const std::vector<Curve> curves = find_curves(results());
  const Curve* curve = find(curves, "clip_length_s", "rate_error_median_rad_s");
  ASSERT_NE(curve, nullptr);
  EXPECT_EQ(curve->source, Curve::Source::samples);
  ASSERT_EQ(curve->lines.size(), 1u);
  std::vector<std::string> labels;
  std::vector<double> medians;
  for (const CurvePoint& point : curve->lines[0].points) {
    labels.push_back(point.label);
    medians.push_back(point.median);
  }
  EXPECT_THAT(labels, ElementsAre("0.025 – 0.055", "0.105 – 0.205", "over 0.405"));
  EXPECT_THAT(medians, ElementsAre(1.0, 2.0, 4.0));
  // a bin without samples remains a gap
  const Figure figure = curve_figure(*curve);
  const auto ticks = nlohmann::json::parse(figure.layout)["xaxis"]["ticktext"];
  EXPECT_THAT(ticks.get<std::vector<std::string>>(),
              ::testing::IsSupersetOf(std::vector<std::string>{"0.055 – 0.105", labels[0], labels[2]}));
  const auto traces = nlohmann::json::parse(figure.traces);
  const auto line = std::find_if(traces.begin(), traces.end(), [](const auto& trace) {
    return trace.value("mode", "") == "lines+markers" && !trace.contains("yaxis");
  });
  ASSERT_NE(line, traces.end());
  ASSERT_EQ((*line)["y"].size(), ticks.size());
  for (std::size_t k = 0; k < ticks.size(); ++k)
    EXPECT_EQ((*line)["y"][k].is_null(), std::find(labels.begin(), labels.end(), ticks[k]) == labels.end()) << ticks[k];
  EXPECT_THAT(summarize(results()).sections.front().metrics, ElementsAre(kMedian));
}

TEST_F(CurvesTest, OverMeasuresOfTheDrawsHaveBinsOfEquallyMany) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto share = seed <= 10 ? 0.0 : 0.01 * static_cast<double>(seed);  // ten draws without clipping
    results().store(scenarios::DrawValues{"hill", seed, {{"motion_clipped_share", share}}});
    store(seed, Kind::slam, "tumble", {}, {{"translation_error_end_m", share}});
  }
  const std::vector<Curve> curves = find_curves(results());
  const Curve* curve = find(curves, "motion_clipped_share", "translation_error_end_m");
  ASSERT_NE(curve, nullptr);
  const std::vector<CurvePoint>& points = curve->lines[0].points;
  ASSERT_EQ(points.size(), 3u) << "30 draws, eight at least in each";
  for (const CurvePoint& point : points) {
    EXPECT_EQ(point.draws, 10);
    EXPECT_NEAR(point.median, point.x, 1e-12) << "the error is the share, so their medians agree";
  }
  EXPECT_NEAR(points[0].x, 0.155, 1e-12);
}

TEST_F(CurvesTest, OfResultsWithoutAnyAreNone) {
  store(1, Kind::rate, "raw", {}, {{kMedian, 1.0}});
  EXPECT_TRUE(find_curves(results()).empty());
  std::vector<Figure> figures;
  EXPECT_EQ(curves_html({}, figures), "");
  EXPECT_TRUE(figures.empty());
}

TEST_F(CurvesTest, ReachThePageWithTheirNumbers) {
  for (const double value : {0.0, 0.01}) store(1, Kind::rate, "raw", {kOffset, value}, {{kMedian, 3.25 + value}});
  PageContent content;
  content.curves = find_curves(results());
  const std::string page = page_html(content, "");
  // the test reads the data that the page passes to Plotly
  const std::string open = "<script type=\"application/json\" id=\"figures\">";
  const std::size_t begin = page.find(open) + open.size();
  const auto figures = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  const std::string id = std::string("curve-hill-rate-") + kOffset + "-" + kMedian;
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0]["id"], id);
  EXPECT_THAT(page, HasSubstr("id=\"" + id + "\""));
  bool found = false;
  for (const nlohmann::json& trace : figures[0]["data"]) {
    found = found || (trace["mode"] == "lines+markers" && trace["y"] == nlohmann::json({3.25, 3.26}));
  }
  EXPECT_TRUE(found);
  content.curves.clear();
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr(id))) << "negative control";
}

TEST_F(CurvesTest, AreFoldedScenarioByScenarioButTheFirst) {
  for (const double value : {0.0, 0.01}) store(1, Kind::rate, "raw", {kOffset, value}, {{kMedian, 3.25 + value}});
  std::vector<Curve> curves = find_curves(results());
  ASSERT_EQ(curves.size(), 1u);
  curves.push_back(curves.front());
  curves.back().scenario = "a<b";
  std::vector<Figure> figures;
  const std::string page = curves_html(curves, figures);
  EXPECT_THAT(page, HasSubstr("<details open><summary>hill · rate</summary>"));
  EXPECT_THAT(page, HasSubstr("<details><summary>a&lt;b · rate</summary>"));
  EXPECT_EQ(figures.size(), 2u);
}

}  // namespace
}  // namespace tumble::tools
