// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/example_choice.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Returns a scenario whose baseline has these errors on seeds 1, 2, ...
Section section_of(const std::string& scenario, Kind kind, const std::vector<double>& errors) {
  MetricSummary metric;
  for (std::size_t i = 0; i < errors.size(); ++i) metric.seeds.push_back(i + 1);
  metric.values = errors;
  metric.centre = median_interval(errors);
  MethodSummary method;
  method.method = "any";
  method.metrics[headline_metrics(kind).front()] = metric;
  Section section;
  section.scenario = scenario;
  section.kind = kind;
  section.baseline = "any";
  section.methods = {method};
  return section;
}

TEST(TypicalSeed, IsTheMedianDrawOfTheBaseline) {
  Summary summary;
  summary.sections = {section_of("a", Kind::rate, {5.0, 1.0, 3.1, 9.0, 2.0})};
  std::uint64_t seed = 0;
  ASSERT_TRUE(typical_seed(summary, "a", seed));
  EXPECT_EQ(seed, 3u);
  EXPECT_FALSE(typical_seed(summary, "b", seed));
  summary.sections = {section_of("a", Kind::attitude, {1.0, 2.0, 3.0})};
  EXPECT_FALSE(typical_seed(summary, "a", seed)) << "attitude says least about the motion";
}

TEST(ExampleChoice, GoesRoundTheRobotsInTheOrderOfTheSuite) {
  Summary summary;
  for (const char* name : {"hill", "scree", "roll", "slip"})
    summary.sections.push_back(section_of(name, Kind::rate, {1.0, 2.0, 3.0}));
  const std::vector<ExampleCandidate> suite = {
      {"hill", "rig"}, {"rejected", "rig"}, {"scree", "rig"}, {"roll", "sphere"}, {"slip", "sphere"}};
  using Draws = std::vector<ExampleDraw>;
  EXPECT_EQ(choose_examples(summary, suite, 2), (Draws{{"hill", 2}, {"roll", 2}})) << "one of each robot first";
  EXPECT_EQ(choose_examples(summary, suite, 3), (Draws{{"hill", 2}, {"scree", 2}, {"roll", 2}}));
  EXPECT_EQ(choose_examples(summary, suite, 9).size(), 4u) << "what has no score is no example";
  EXPECT_TRUE(choose_examples(summary, suite, 0).empty());
}

/// Returns a method that failed on these seeds.
MethodSummary failing(const std::string& name, std::vector<std::uint64_t> seeds, bool needs_truth = false) {
  MethodSummary method;
  method.method = name;
  method.needs_truth = needs_truth;
  method.seeds = {1, 2, 3, 4};
  method.not_ok_seeds = std::move(seeds);
  return method;
}

TEST(FailureChoice, IsTheDrawOnWhichMostMethodsFailed) {
  Summary summary;
  Section hill = section_of("hill", Kind::slam, {1.0, 2.0}), scree = section_of("scree", Kind::slam, {1.0, 2.0});
  hill.methods = {failing("a", {2, 3}), failing("b", {3})};
  scree.methods = {failing("a", {1, 4}), failing("b", {4}), failing("c", {4}), failing("d", {1}, true)};
  summary.sections = {hill, scree};
  const std::vector<ExampleCandidate> suite = {{"hill", "rig"}, {"scree", "rig"}, {"roll", "sphere"}};
  using Draws = std::vector<ExampleDraw>;
  EXPECT_EQ(choose_failures(summary, suite, 2), (Draws{{"scree", 4}, {"hill", 3}})) << "three failed on the one";
  EXPECT_EQ(choose_failures(summary, suite, 1), (Draws{{"scree", 4}}));
  EXPECT_TRUE(choose_failures(summary, suite, 0).empty());
  const Draws all = {{"scree", 4}, {"hill", 3}, {"hill", 2}, {"scree", 1}};
  EXPECT_EQ(choose_failures(summary, suite, 9), all) << "also several of a scenario, of equals by name and seed";
  const std::vector<ExampleCandidate> hills = {{"hill", "rig"}};
  EXPECT_EQ(choose_failures(summary, hills, 9), (Draws{{"hill", 3}, {"hill", 2}}));
}

TEST(FailureChoice, IsNoneWhereNothingFailedOrOnlyWhatKnowsTheTruth) {
  Summary summary;
  Section hill = section_of("hill", Kind::slam, {1.0, 2.0});
  hill.methods = {failing("a", {}), failing("oracle", {1, 2}, true)};
  summary.sections = {hill};
  EXPECT_TRUE(choose_failures(summary, std::vector<ExampleCandidate>{{"hill", "rig"}}, 3).empty());
}

}  // namespace
}  // namespace tumble::scenarios
