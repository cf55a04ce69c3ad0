// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.hpp"
#include "tools/report/sensitivity_html.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/summary/comparison.hpp"
#include "tests/testing.hpp"
#include "tests/tools/some_summary.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::MetricSummary;
using scenarios::Summary;

/// Returns an example with one picture, one plot and a legend, under names that would end an element.
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
  content.summary = page_summary("hill");
  content.errors = {box_figure(content.summary, Kind::rate, "rate_error_clipped_median_rad_s", "caption")};
  const std::string page = page_html(content, "/* bundle */");
  for (const char* outside : {"http:", "https:", "src=\"/", "@import", "url(", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_THAT(page, HasSubstr("/* bundle */"));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'")) << "nor may it";
}

TEST(Page, EscapesEveryTextItIsGiven) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  PageContent content;
  content.title = evil;
  content.versions = {{evil, evil}};
  content.methods = {{evil, evil}};
  content.commands = {{evil, evil}};
  content.failed = {1, {{evil, 7, {{evil, evil, evil, evil}}, evil}}};
  content.sensitivity_note = evil;
  content.sensitivity = {{evil, Kind::rate, evil, evil, 30, {{evil, {}, {}, 0.0, 1.0, 2.0}}}};
  content.motion_map = scenarios::motion_map(std::vector<scenarios::DrawValues>{
      {evil, 7, {{"motion_peak_rate_rad_s", 10.0}, {"motion_peak_accel_m_s2", 90.0}}}});
  content.warnings = {evil};
  content.examples = {evil_example(evil)};
  content.summary = page_summary(evil, evil);
  content.errors = {box_figure(content.summary, Kind::rate, "rate_error_clipped_median_rad_s", evil)};
  content.comparison = scenarios::compare(content.summary, {});
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  std::size_t scripts = 0;
  for (std::size_t at = page.find("</script>"); at != std::string::npos; at = page.find("</script>", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 3u) << "figures, bundle and the page's own, and none out of the texts";
}

TEST(Page, ShowsExamplesWithTheirPicturesAndPlots) {
  PageContent content;
  content.examples = {evil_example("hill")};
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, HasSubstr("One hill of <code>hill</code>, seed 7"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw==\""));
  EXPECT_THAT(page, HasSubstr("id=\"hill-hill-7\""));
  EXPECT_THAT(page, HasSubstr("not match these results")) << "it is not of these";
  content.examples[0].of_these_results = true;
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("not match these results")));
  content.examples.clear();
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("hill"))) << "negative control";
}

TEST(Page, LinksTheReplayOfAnExampleThatHasOne) {
  PageContent content;
  content.examples = {evil_example("hill")};
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("Open the replay"))) << "it has none";
  content.examples[0].replay_address = "a.db.files/hill-7-replay.html";
  EXPECT_THAT(page_html(content, ""), HasSubstr("<a href=\"a.db.files/hill-7-replay.html\">"));
}

TEST(Page, SaysWhichOfTheTwoFailed) {
  PageContent content;
  content.summary = page_summary("hill");
  MetricSummary& raw = content.summary.sections[0].methods[0].metrics["rate_error_clipped_median_rad_s"];
  raw.failed = raw.seeds;
  raw.seeds.clear();
  raw.values.clear();
  content.comparison = scenarios::compare(content.summary, {});
  EXPECT_THAT(page_html(content, ""), HasSubstr("raw failed on at least half of the simulated runs"));
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("saave failed")));
}

TEST(Page, CountsMethodsThatNeedNoTruth) {
  PageContent content;
  content.summary = page_summary("hill");
  EXPECT_THAT(page_html(content, ""), HasSubstr("This page compares 2 estimators"));
  content.summary.sections[0].methods[1].needs_truth = true;
  EXPECT_THAT(page_html(content, ""), HasSubstr("This page compares 1 estimator for"));
}

TEST(Page, ShowsADrawOfTheseResultsBeforeOneThatMoves) {
  PageContent content;
  content.examples = {evil_example("hill"), evil_example("roll")};
  content.examples[0].example.moving = {'R', 'I', 'F', 'F'};
  const auto front = [&] {
    const std::string page = page_html(content, "");
    const std::size_t at = page.find("<figure class=\"moving\">");
    return page.substr(at, page.find("</figure>", at) - at);
  };
  EXPECT_THAT(front(), HasSubstr("One hill"));
  EXPECT_THAT(front(), HasSubstr("does not match these results"));
  content.examples[1].of_these_results = true;
  EXPECT_THAT(front(), HasSubstr("One roll"));
  EXPECT_THAT(front(), Not(HasSubstr("not match these results")));
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

TEST(Page, HasItsPartsInOrderAndInTheListOfContents) {
  PageContent content;
  content.summary = page_summary("hill");
  content.comparison = scenarios::compare(content.summary, {});
  content.errors = {box_figure(content.summary, Kind::rate, "rate_error_clipped_median_rad_s", "")};
  content.cost = content.errors.front();
  content.cost.id = "cost-figure";
  content.sensitivity_note = "too few";
  content.versions = {{"build", "1"}};
  content.commands = {{"This page", "tumble report"}};
  const std::string page = page_html(content, "");
  std::size_t at = page.find("<h1>");
  ASSERT_NE(at, std::string::npos);
  for (const char* part :
       {"motions", "errors", "differences", "failures", "sensitivity", "cost", "certificate", "versions", "again"}) {
    EXPECT_THAT(page, HasSubstr(std::string("<a href=\"#") + part + "\">"));
    const std::size_t next = page.find(std::string("<section id=\"") + part + "\">");
    ASSERT_NE(next, std::string::npos) << part;
    EXPECT_GT(next, at) << part;
    at = next;
  }
  EXPECT_THAT(page_html({}, ""), Not(HasSubstr("<a href=\"#errors\">"))) << "of nothing there is nothing to go to";
}

// in the first class the score is small and certain; in the last it has no upper end
TEST(Page, DrawsAScoreOverTheRangeOfWhatBreaksIt) {
  PageContent content;
  content.summary = page_summary("hill");
  scenarios::Influence slope{"world.<slope>", {}, {}, 0.001, 0.1, 2.0};
  const double infinity = std::numeric_limits<double>::infinity();
  slope.dependence = {
      {0.1, 0.2, 12, {0.1, 0.05, 0.2}}, {0.3, 0.4, 12, {1.0, 0.5, 2.0}}, {0.4, 0.9, 12, {3.0, 1.0, infinity}}};
  content.sensitivity = {{"hill", Kind::rate, "raw", "rate_error_clipped_median_rad_s", 36, {slope}}};
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, HasSubstr("<svg class=\"dependence\""));
  EXPECT_THAT(
      page,
      HasSubstr(
          "<title>world.&lt;slope&gt; from 0.1 to 0.2: 0.100 rad/s [0.0500, 0.200] in 12 simulated runs</title>"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("=\"inf"))) << "an infinite end lies on the frame";
  content.sensitivity[0].influences[0].dependence.resize(1);
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("<svg class=\"dependence\""))) << "one class has no shape";
}

TEST(Page, StatesHowManyMoreDrawsTheSensitivityNeeds) {
  EXPECT_EQ(draws_needed_text({{"hill", 24}, {"roll", 500}}), "");
  EXPECT_EQ(
      draws_needed_text({{"hill", 5}, {"roll", 500}, {"slip", 23}}),
      "A scenario needs 12 simulated runs to compute the influence of its parameters. A plot of the score against a "
      "parameter needs 24 simulated runs. These scenarios need more runs: hill 7, and 19 for the plot; slip 1 "
      "for the plot. ");
}

TEST(Page, MovesByItselfAndStandsStillForWhoeverAsks) {
  PageContent content;
  content.examples = {evil_example("hill")};
  EXPECT_THAT(page_html(content, ""), Not(HasSubstr("image/webp"))) << "nothing moves in it";
  content.examples[0].example.moving = {'R', 'I', 'F', 'F'};
  content.examples[0].example.moving_caption = "2 s of <it>";
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, HasSubstr("src=\"data:image/webp;base64,UklGRg==\""));
  EXPECT_THAT(page, HasSubstr("<source media=\"print, (prefers-reduced-motion: reduce)\" srcset=\"data:image/png"));
  EXPECT_THAT(page, HasSubstr("2 s of &lt;it&gt;"));
}

TEST(Page, LinksFailedDrawsThatHavePictures) {
  PageContent content;
  content.summary = page_summary("hill");
  content.examples = {evil_example("hill")};
  content.examples[0].replay_address = "a.db.files/hill-7-replay.html";
  content.failed = {
      2,
      {{"hill", 7, {{"rate/saave", "diverged", "went away", "tumble run hill --seed 7"}}, "tumble replay 7"},
       {"hill", 8, {{"rate/saave", "diverged", "", "tumble run hill --seed 8"}}, "tumble replay 8"}}};
  const std::string page = page_html(content, "");
  EXPECT_THAT(page, HasSubstr("<a href=\"#draw-hill-7\">pictures</a>"));
  EXPECT_THAT(page, HasSubstr("<details id=\"draw-hill-7\""));
  EXPECT_THAT(page, HasSubstr("<a href=\"a.db.files/hill-7-replay.html\">replay</a>"));
  EXPECT_THAT(page, HasSubstr("<pre>tumble run hill --seed 7</pre>"));
  EXPECT_THAT(page, Not(HasSubstr("#draw-hill-8"))) << "negative control: nothing is there to be seen";
  EXPECT_THAT(page, HasSubstr("<pre>tumble replay 8</pre>"));
  EXPECT_THAT(page, Not(HasSubstr("tumble replay 7"))) << "it has one";
}

TEST(Page, ShowsAFailedDrawInTheSectionOfFailures) {
  PageContent content;
  content.summary = page_summary("hill");
  content.examples = {evil_example("roll"), evil_example("hill")};
  content.examples[1].example.of_failure = true;
  content.examples[1].replay_address = "a.db.files/hill-7-replay.html";
  content.failed = {1, {{"hill", 7, {{"rate/saave", "diverged", "went away", "tumble run hill --seed 7"}}, ""}}};
  const std::string page = page_html(content, "");
  const std::size_t draw = page.find("<details id=\"draw-hill-7\"><summary>picture"),
                    failures = page.find("<section id=\"failures\">"),
                    command = page.find("<pre>tumble run hill --seed 7");
  EXPECT_LT(failures, draw);
  EXPECT_LT(draw, command);
  EXPECT_LT(command, page.size());
  EXPECT_THAT(page, HasSubstr("<a href=\"a.db.files/hill-7-replay.html\">replay</a>"));
  EXPECT_THAT(page, Not(HasSubstr("One hill"))) << "and not among the typical draws";
  EXPECT_THAT(page, HasSubstr("One roll"));
}

TEST(AtMost, KeepsTheEndsAndTheQuartiles) {
  std::vector<double> values;
  for (int i = 1000; i >= 0; --i) values.push_back(i);
  const std::vector<double> some = at_most(values, 101);
  ASSERT_EQ(some.size(), 101u);
  EXPECT_EQ(some.front(), 0.0);
  EXPECT_EQ(some[25], 250.0);
  EXPECT_EQ(some.back(), 1000.0);
  EXPECT_EQ(at_most({3.0, 1.0, 2.0}, 3), (std::vector<double>{3.0, 1.0, 2.0})) << "few stay as they are";
}

}  // namespace
}  // namespace tumble::tools
