// SPDX-License-Identifier: BSD-3-Clause
// The test checks a page's figures and the tables next to them: how they show failed draws and distinguish methods.
#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tests/tools/some_summary.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/report/page.hpp"
#include "tools/report/plots.hpp"
#include "tools/report/score_html.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::Summary;

TEST(BoxFigure, HasATracePerMethodWithEveryDraw) {
  const Figure figure = box_figure(page_summary("hill"), Kind::rate, "rate_error_clipped_median_rad_s", "");
  ASSERT_EQ(nlohmann::json::parse(figure.traces).size(), 2u);
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[0]["name"], "raw");
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[1]["y"], nlohmann::json({0.1, 0.2}));
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[1]["x"], nlohmann::json({"hill", "hill"}));
  EXPECT_EQ(nlohmann::json::parse(figure.layout)["yaxis"]["type"], "log") << "0.1 to 3 is more than a decade";
  EXPECT_TRUE(box_figure(page_summary("hill"), Kind::slam, "map_overlap", "").empty());
}

/// Failed draws are on a separate line beyond the worst value, and count in the quartiles of the box.
TEST(BoxFigure, ShowsDrawsThatFailed) {
  Summary summary = page_summary("hill");
  MetricSummary& raw = summary.sections[0].methods[0].metrics["rate_error_clipped_median_rad_s"];
  raw.failed = {3, 4, 5};
  const Figure figure = box_figure(summary, Kind::rate, "rate_error_clipped_median_rad_s", "");
  const auto traces = nlohmann::json::parse(figure.traces), layout = nlohmann::json::parse(figure.layout);
  EXPECT_EQ(traces[0]["y"], nlohmann::json({2.0, 3.0, 6.0, 6.0, 6.0})) << "twice the worst, on a logarithmic axis";
  EXPECT_EQ(traces[0]["x"].size(), 5u);
  EXPECT_EQ(traces[1]["y"].size(), 2u);
  EXPECT_EQ(layout["annotations"][0]["text"], "failed");
  EXPECT_EQ(layout["shapes"][0]["y0"], 6.0);
  const Figure whole = box_figure(page_summary("hill"), Kind::rate, "rate_error_clipped_median_rad_s", "");
  EXPECT_FALSE(nlohmann::json::parse(whole.layout).contains("annotations"));
}

TEST(Page, AMethodHasOneColourInEveryFigure) {
  Palette palette;
  palette.add("slam/tumble", 1);  // as in a picture of an example
  palette.add("raw");
  palette.add("saave", 0);
  palette.add("rate/tumble");
  EXPECT_EQ(palette.index("tumble", 9), 1u);
  EXPECT_EQ(palette.index("rate/raw", 9), 0u);
  EXPECT_EQ(palette.index("saave", 9), 2u) << "0 is taken";
  EXPECT_EQ(palette.index("unknown", 9), 9u);
  const std::string metric = "rate_error_clipped_median_rad_s";
  Summary summary = page_summary("hill");
  summary.sections[0].methods[1].method = "tumble";
  summary.sections[0].methods[1].metrics["estimate_cpu_s"] = summary.sections[0].methods[1].metrics[metric];
  const auto boxes = nlohmann::json::parse(box_figure(summary, Kind::rate, metric, "", palette).traces);
  const auto cost = nlohmann::json::parse(cost_figure(summary, palette).traces);
  Plot plot;
  plot.lines = {{"tumble", 0, 1.0, false, false, {0.0}, {0.0}}};
  const auto lines = nlohmann::json::parse(figure_of(plot, "a", palette).traces);
  scenarios::Curve curve;
  curve.lines.push_back({"tumble", std::vector<scenarios::CurvePoint>(1)});
  const auto curves = nlohmann::json::parse(curve_figure(curve, palette).traces);
  const std::string own = method_colour(1).hex;
  EXPECT_EQ(boxes[1]["line"]["color"], own);
  EXPECT_EQ(cost[0]["line"]["color"], own);
  EXPECT_EQ(lines[0]["line"]["color"], own);
  EXPECT_EQ(curves.back()["line"]["color"], own);
}

TEST(Page, AxesAreNamedInTheUnitThatTheyShow) {
  EXPECT_EQ(axis_title("rate_error_clipped_median_rad_s"), "rate error clipped median [rad/s]");
  EXPECT_EQ(axis_title("attitude_rmse_rad"), "attitude rmse [°]");
  EXPECT_EQ(axis_title("position_end_error_share"), "position end error share [%]");
  EXPECT_EQ(axis_title("world.rock_count"), "world.rock_count");
}

TEST(Page, SaysHowFastMethodsAre) {
  PageContent content;
  content.summary = page_summary("hill");
  content.summary.sections[0].methods[0].metrics["estimate_cpu_s"] = metric({0.5, 0.25});
  const std::vector<scenarios::DrawValues> draws = {{"hill", 1, {{"motion_duration_s", 10.0}}},
                                                    {"hill", 2, {{"motion_duration_s", 10.0}}}};
  content.costs = cost_rows(content.summary, draws);
  ASSERT_EQ(content.costs.size(), 1u);
  EXPECT_EQ(content.costs[0].method, "rate/raw");
  EXPECT_EQ(content.costs[0].real_time_factor, 30.0) << "20 and 40";
  content.cost = cost_figure(content.summary);
  EXPECT_THAT(page_html(content, ""), HasSubstr("<th class=\"number\">real-time factor</th>"));
}

TEST(Page, FullCoverageIsNotTheBest) {
  const std::string metric_name = "rate_coverage_3sigma";
  Summary summary = page_summary("hill");
  for (std::size_t k = 0; k < 2; ++k)
    summary.sections[0].methods[k].metrics[metric_name] = metric({k == 0 ? 1.0 : 0.98, 0.98});
  summary.sections[0].metrics = {metric_name};
  const std::string table = score_table_html(summary.sections[0]);
  EXPECT_THAT(table, HasSubstr("<td class=\"number best\"><b>98.0"));
  EXPECT_THAT(table, Not(HasSubstr("<td class=\"number best\"><b>100")));
}

// there are six colours: further methods have another symbol and filling, and lines have other dashes
TEST(Page, DistinguishesMoreMethodsThanThereAreColours) {
  Summary summary = page_summary("hill");
  Section& section = summary.sections[0];
  while (section.methods.size() < 20) {
    section.methods.push_back(section.methods[0]);
    section.methods.back().method = "m" + std::to_string(section.methods.size());
  }
  const auto traces =
      nlohmann::json::parse(box_figure(summary, Kind::rate, "rate_error_clipped_median_rad_s", "").traces);
  ASSERT_EQ(traces.size(), 20u);
  std::set<std::string> boxes, lines;
  Plot plot;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    boxes.insert(traces[i]["marker"]["color"].dump() + traces[i]["marker"]["symbol"].dump());
    if (i < 18) boxes.insert(traces[i]["line"]["color"].dump() + traces[i]["fillcolor"].dump());
    plot.lines.push_back({"line", static_cast<int>(i), 1.0, false, false, {0.0}, {0.0}});
  }
  for (const auto& line : nlohmann::json::parse(figure_of(plot, "a").traces)) lines.insert(line["line"].dump());
  EXPECT_EQ(boxes.size(), 38u);
  EXPECT_EQ(lines.size(), 20u);
}

}  // namespace
}  // namespace tumble::tools
