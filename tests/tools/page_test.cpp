// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/report/plots.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using ::testing::HasSubstr;
using ::testing::Not;

MetricSummary metric(std::vector<double> values) {
  MetricSummary out;
  for (std::size_t i = 0; i < values.size(); ++i) out.seeds.push_back(i + 1);
  out.centre = {values.front(), values.front(), values.front()};
  out.values = std::move(values);
  return out;
}

Summary summary_of(const std::string& scenario) {
  MethodSummary raw, saave;
  raw.method = "raw";
  raw.metrics["rate_error_clipped_median_rad_s"] = metric({2.0, 3.0});
  saave.method = "saave";
  saave.metrics["rate_error_clipped_median_rad_s"] = metric({0.1, 0.2});
  Section section;
  section.scenario = scenario;
  section.kind = Kind::rate;
  section.baseline = "raw";
  section.methods = {raw, saave};
  section.metrics = {"rate_error_clipped_median_rad_s"};
  Summary summary;
  summary.sections = {section};
  summary.scenarios = {scenario};
  summary.draws[scenario] = 2;
  return summary;
}

TEST(Page, AsksTheNetworkNothing) {
  PageContent content;
  content.title = "title";
  content.summary = summary_of("hill");
  content.figures = {box_figure(content.summary, Kind::rate, "rate_error_clipped_median_rad_s", "caption")};
  const std::string page = page_html(content, "/* bundle */");
  for (const char* outside : {"http:", "https:", "src=\"/", "@import", "url(", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_THAT(page, HasSubstr("/* bundle */"));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme"));
}

TEST(Page, EscapesEveryTextItIsGiven) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  PageContent content;
  content.title = evil;
  content.facts = {{evil, evil}};
  content.warnings = {evil};
  content.summary = summary_of(evil);
  content.figures = {box_figure(content.summary, Kind::rate, "rate_error_clipped_median_rad_s", evil)};
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  std::size_t scripts = 0;
  for (std::size_t at = page.find("</script>"); at != std::string::npos; at = page.find("</script>", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 3u) << "figures, bundle and the page's own, and none out of the texts";
}

TEST(BoxFigure, HasATracePerMethodWithEveryDraw) {
  const Figure figure = box_figure(summary_of("hill"), Kind::rate, "rate_error_clipped_median_rad_s", "");
  ASSERT_EQ(figure.data.size(), 2u);
  EXPECT_EQ(figure.data[0]["name"], "raw");
  EXPECT_EQ(figure.data[1]["y"], nlohmann::json({0.1, 0.2}));
  EXPECT_EQ(figure.data[1]["x"], nlohmann::json({"hill", "hill"}));
  EXPECT_EQ(figure.layout["yaxis"]["type"], "log") << "0.1 to 3 is more than a decade";
  EXPECT_TRUE(box_figure(summary_of("hill"), Kind::slam, "map_overlap", "").empty());
}

/// A recording of four samples whose gyro y axis is flat, with what raw would make of it.
Example clipped_example() {
  Example example;
  example.run.situation.scenario = "hill";
  example.run.methods = scenarios::find_methods("rate/raw");
  scenarios::Estimate estimate;
  sim::Recording& recording = example.run.recording;
  recording.truth.period_ns = 10000000;
  recording.sensors.imus.resize(1);
  recording.truth.imus.resize(1);
  for (int k = 0; k < 4; ++k) {
    recording.truth.p_WB_m.emplace_back(k, 0, 0);
    recording.truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    recording.truth.v_WB_m_s.emplace_back(1, 0, 0);
    recording.truth.w_WB_B_rad_s.emplace_back(0, 15, 0);
    recording.sensors.imus[0].time_ns.push_back(10000000 * k);
    recording.truth.imus[0].rate_rad_s.emplace_back(0, 15 + k, 0);
    RateState rate;
    rate.time_ns = 10000000 * k;
    rate.w_WI_I_rad_s = {0, 10.5, 0};
    rate.clipped_axes = 2;
    estimate.rates.push_back(rate);
  }
  example.run.estimates = {estimate};
  return example;
}

TEST(RateFigure, ShowsTheAxisThatClips) {
  const Figure figure = rate_figure(clipped_example());
  ASSERT_EQ(figure.data.size(), 2u);
  EXPECT_EQ(figure.data[0]["y"], nlohmann::json({15.0, 16.0, 17.0, 18.0}));
  EXPECT_EQ(figure.data[1]["y"], nlohmann::json({10.5, 10.5, 10.5, 10.5}));
  EXPECT_THAT(figure.caption, HasSubstr("y axis"));
}

TEST(RateFigure, IsEmptyWhenNothingClips) {
  Example example = clipped_example();
  for (RateState& rate : example.run.estimates[0].rates) rate.clipped_axes = 0;
  EXPECT_TRUE(rate_figure(example).empty());
}

TEST(PathFigure, HasEqualScales) {
  Example example = clipped_example();
  const Figure figure = path_figure(example);
  ASSERT_EQ(figure.data.size(), 1u);
  EXPECT_EQ(figure.data[0]["x"], nlohmann::json({0.0, 1.0, 2.0, 3.0}));
  EXPECT_EQ(figure.layout["yaxis"]["scaleanchor"], "x");
}

}  // namespace
}  // namespace tumble::tools
