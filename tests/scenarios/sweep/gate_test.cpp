// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/temporary_folder.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;

constexpr const char* kMetric = "translation_error_end_m";

class GateTest : public testing::TemporaryFolder {
 protected:
  /// Seeds 1 to 5: errors 0.1 to 0.5 m; overlaps 0.91 to 0.95.
  void store_draws(Results& results) const {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Outcome outcome;
      outcome.scenario = "hill";
      outcome.seed = seed;
      outcome.kind = Kind::slam;
      outcome.method = "tumble";
      outcome.status = "ok";
      const auto number = static_cast<double>(seed);
      outcome.scores = {{kMetric, 0.1 * number}, {"map_overlap", 0.9 + 0.01 * number}};
      results.store(outcome);
    }
  }
  static void store_failure(Results& results, std::uint64_t seed) {
    Outcome outcome;
    outcome.scenario = "hill";
    outcome.seed = seed;
    outcome.kind = Kind::slam;
    outcome.method = "tumble";
    outcome.status = "crashed";
    results.store(outcome);
  }
  Results results() const { return Results(folder_ / "g.db", Results::Mode::create_or_append); }

  static GateBound bound(Statistic statistic, const std::string& metric) {
    GateBound out;
    out.scenario = "hill";
    out.kind = Kind::slam;
    out.method = "tumble";
    out.statistic = statistic;
    out.metric = metric;
    return out;
  }
  static double value(const Results& results, const GateBound& bound, std::uint64_t last = 100) {
    return hold_to_gate(results, {"s", 0.0, {bound}}, 1, last).at(0).value;
  }

  std::string complaint(const std::string& text) const {
    write("bad.yaml", text);
    try {
      load_gate(DataRoot{folder_}, (folder_ / "bad.yaml").string());
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(GateTest, StatisticsOfTheSeedsAsked) {
  Results all = results();
  store_draws(all);
  EXPECT_DOUBLE_EQ(value(all, bound(Statistic::median, kMetric)), 0.3);
  EXPECT_DOUBLE_EQ(value(all, bound(Statistic::median, kMetric), 3), 0.2);
  EXPECT_NEAR(value(all, bound(Statistic::quantile_95, kMetric)), 0.48, 1e-12);  // type 7: 0.4 + 0.8 of the last step
  EXPECT_NEAR(value(all, bound(Statistic::quantile_05, "map_overlap")), 0.912, 1e-12);
  EXPECT_EQ(value(all, bound(Statistic::share_not_ok, "")), 0.0);
}

TEST_F(GateTest, AFailureRanksAsTheWorst) {
  Results all = results();
  store_draws(all);
  for (const std::uint64_t seed : {6, 7, 8, 9, 10}) store_failure(all, seed);
  EXPECT_EQ(value(all, bound(Statistic::share_not_ok, "")), 0.5);
  EXPECT_EQ(value(all, bound(Statistic::quantile_95, kMetric)), std::numeric_limits<double>::infinity());
  EXPECT_EQ(value(all, bound(Statistic::quantile_05, "map_overlap")), -std::numeric_limits<double>::infinity());
}

TEST_F(GateTest, WithoutOutcomesNothingPasses) {
  const Results none = results();
  GateBound wide = bound(Statistic::median, kMetric);
  const std::vector<GateResult> held = hold_to_gate(none, {"s", 0.0, {wide}}, 1, 9);
  ASSERT_EQ(held.size(), 1u);
  EXPECT_TRUE(std::isnan(held[0].value));
  EXPECT_FALSE(held[0].passes());
}

TEST_F(GateTest, AcceptedBoundsPassTheirRunAndFailAWorseOne) {
  Results all = results();
  store_draws(all);
  const Gate proposed = proposed_gate(all, "hill");
  ASSERT_FALSE(proposed.bounds.empty());
  // rotation_error_end_rad has no value here
  Gate gate{
      "hill",
      0.0,
      {bound(Statistic::median, kMetric), bound(Statistic::median, "map_overlap"), bound(Statistic::share_not_ok, "")}};
  gate = accept(gate, hold_to_gate(all, gate, 1, 5), 0.1);
  EXPECT_DOUBLE_EQ(gate.bounds[0].high, 0.33);
  EXPECT_EQ(gate.bounds[0].low, -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(gate.bounds[1].low, 0.93 * 0.9, 1e-12);
  EXPECT_EQ(gate.bounds[1].high, std::numeric_limits<double>::infinity());
  EXPECT_EQ(gate.bounds[2].high, 0.0);  // none failed: none may
  for (const GateResult& result : hold_to_gate(all, gate, 1, 5)) EXPECT_TRUE(result.passes()) << result.value;

  // negative control: three of eight fail, which moves every one of the three figures out
  for (const std::uint64_t seed : {6, 7, 8}) store_failure(all, seed);
  const std::vector<GateResult> worse = hold_to_gate(all, gate, 1, 8);
  EXPECT_FALSE(worse[0].passes()) << worse[0].value;
  EXPECT_FALSE(worse[2].passes()) << worse[2].value;
}

TEST_F(GateTest, ARunWithoutAFigureCannotBeAccepted) {
  const Results none = results();
  const Gate gate{"hill", 0.0, {bound(Statistic::median, kMetric)}};
  EXPECT_THROW(accept(gate, hold_to_gate(none, gate, 1, 5), 0.1), BadInput);
  EXPECT_THROW(accept(gate, {}, -0.1), BadInput);
}

TEST_F(GateTest, YamlReadsBackExactly) {
  Results all = results();
  store_draws(all);
  Gate gate{"hill", 0.0, {bound(Statistic::quantile_95, kMetric), bound(Statistic::share_not_ok, "")}};
  gate = accept(gate, hold_to_gate(all, gate, 1, 5), 0.3);
  write("scenarios/gates/hill.yaml", to_yaml(gate));
  const DataRoot data{folder_};
  EXPECT_THAT(gate_names(data), ::testing::ElementsAre("hill"));
  const Gate back = load_gate(data, "hill");
  EXPECT_EQ(back.suite, "hill");
  EXPECT_EQ(back.margin, 0.3);
  ASSERT_EQ(back.bounds.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.bounds[i].metric, gate.bounds[i].metric);
    EXPECT_EQ(back.bounds[i].statistic, gate.bounds[i].statistic);
    EXPECT_EQ(back.bounds[i].accepted, gate.bounds[i].accepted);
    EXPECT_EQ(back.bounds[i].low, gate.bounds[i].low);
    EXPECT_EQ(back.bounds[i].high, gate.bounds[i].high);
  }
}

TEST_F(GateTest, SaysWhatIsWrongAndWhere) {
  const std::string head = "suite: hill\nmargin: 0.1\nbounds:\n";
  EXPECT_THAT(complaint(head + "  - {scenario: hill, kind: slm, method: tumble, statistic: median, metric: "
                               "map_overlap, accepted: 1, low: 0}"),
              ::testing::AllOf(HasSubstr("bad.yaml:4"), HasSubstr("'slam'")));
  EXPECT_THAT(complaint(head + "  - {scenario: hill, kind: slam, method: tumbel, statistic: median, metric: "
                               "map_overlap, accepted: 1, low: 0}"),
              HasSubstr("tumble"));
  EXPECT_THAT(complaint(head + "  - {scenario: hill, kind: slam, method: tumble, statistic: median, metric: "
                               "map_overlp, accepted: 1, low: 0}"),
              HasSubstr("'map_overlap'"));
  EXPECT_THAT(
      complaint(
          head +
          "  - {scenario: hill, kind: slam, method: tumble, statistic: median, metric: map_overlap, accepted: 1}"),
      HasSubstr("needs low or high"));
  EXPECT_THAT(complaint(head + "  - {scenario: hill, kind: slam, method: tumble, statistic: median, metric: "
                               "map_overlap, accepted: 1, low: 2, high: 1}"),
              HasSubstr("high is below low"));
  EXPECT_THAT(complaint(head + "  - {scenario: hill, kind: slam, method: tumble, statistic: mean, metric: map_overlap, "
                               "accepted: 1, low: 2}"),
              HasSubstr("'mean'"));
  EXPECT_THAT(complaint("suite: hill\nmargin: 0.1\nbounds: []\n"), HasSubstr("no bound"));
  try {
    load_gate(DataRoot{folder_}, "slip");
    FAIL() << "a gate out of nothing";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("--accept"));
  }
}

}  // namespace
}  // namespace tumble::scenarios
