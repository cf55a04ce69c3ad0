// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/report/plots.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::MethodSummary;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::Summary;
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

/// An example with one picture, one plot and a legend, under names that would end an element.
ShownExample evil_example(const std::string& evil) {
  ShownExample shown;
  shown.example.scenario = shown.example.motion = shown.example.choice = evil;
  shown.example.seed = 7;
  shown.example.pictures = {{"scene", evil, evil, {{evil, kTruthColour}}, {0x89, 'P', 'N', 'G'}}};
  Plot plot;
  plot.name = plot.caption = plot.x_title = evil;
  plot.lines = {{evil, 0, 1.0, false, false, {0.0, 1.0}, {2.0, 3.0}}};
  shown.example.plots = {plot};
  return shown;
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
  content.examples = {evil_example(evil)};
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

TEST(Page, ShowsExamplesWithTheirPicturesAndPlots) {
  PageContent content;
  content.examples = {evil_example("hill")};
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, HasSubstr("One hill of <code>hill</code>, seed 7"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw==\""));
  EXPECT_THAT(page, HasSubstr("id=\"hill-hill\""));
  EXPECT_THAT(page, HasSubstr("other results")) << "it is not of these";
  content.examples[0].of_these_results = true;
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("other results")));
  content.examples.clear();
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("hill"))) << "negative control";
}

TEST(Page, LinksTheReplayOfAnExampleThatHasOne) {
  PageContent content;
  content.examples = {evil_example("hill")};
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("<a href"))) << "it has none";
  content.examples[0].replay_address = "a.db.files/hill-7-replay.html";
  EXPECT_THAT(page_html(content, ""), HasSubstr("<a href=\"a.db.files/hill-7-replay.html\">"));
}

TEST(Page, SetsNarrowPlotsTwoInARow) {
  PageContent content;
  content.examples = {evil_example("hill")};
  std::vector<Plot>& plots = content.examples[0].example.plots;
  plots.resize(4, plots[0]);
  plots[1].wide = plots[2].wide = false;
  const std::string page = page_html(content, "");
  const std::size_t open = page.find("<div class=\"pair\">");
  ASSERT_NE(open, std::string::npos);
  EXPECT_EQ(page.find("<div class=\"pair\">", open + 1), std::string::npos) << "one pair";
}

}  // namespace
}  // namespace tumble::tools
