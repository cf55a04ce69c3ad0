// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/hold_case.hpp"

#include "scenarios/cases/complication.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr const char* kMetric = "translation_error_end_m";

Outcome slam_outcome(OutcomeStatus status, double error_m, bool map_failed) {
  Outcome out;
  out.kind = Kind::slam;
  out.method = "tumble";
  out.status = status;
  out.scores = {{kMetric, error_m}, {"map_failed", map_failed ? 1.0 : 0.0}};
  return out;
}

Expectation expects(bool fails, double value) {
  Expectation expected;
  expected.method = "slam/tumble";
  expected.fails = fails;
  expected.metric = kMetric;
  expected.status = "ok";
  expected.value = value;
  return expected;
}

std::string fault(const Expectation& expected, const Outcome& of) {
  return hold_case("name", expected, of).fault;
}

TEST(HoldCase, WhatHoldsHasToHold) {
  const Expectation holds = expects(false, 0.1);
  EXPECT_THAT(fault(holds, slam_outcome(OutcomeStatus::ok, 0.1, false)), IsEmpty());
  EXPECT_THAT(fault(holds, slam_outcome(OutcomeStatus::ok, 9.0, false)), IsEmpty()) << "no bound was asked for";
  EXPECT_THAT(fault(holds, slam_outcome(OutcomeStatus::ok, 0.1, true)), HasSubstr("fails: ok"));
  EXPECT_THAT(fault(holds, slam_outcome(OutcomeStatus::diverged, 0.1, false)), HasSubstr("fails: diverged"));
  Expectation bounded = holds;
  bounded.worse_than = 1.0;
  EXPECT_THAT(fault(bounded, slam_outcome(OutcomeStatus::ok, 0.9, false)), IsEmpty());
  EXPECT_THAT(fault(bounded, slam_outcome(OutcomeStatus::ok, 1.1, false)), HasSubstr("1.1"));
}

TEST(HoldCase, AFailureHasTwoBounds) {
  const Expectation fails = expects(true, 2.0);
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::ok, 2.0, true)), IsEmpty());
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::ok, 3.9, true)), IsEmpty());
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::ok, 1.1, true)), IsEmpty());
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::ok, 4.1, true)),
              HasSubstr("is 4.1, but the accepted value is 2"));
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::diverged, 2.0, true)),
              HasSubstr("fails with status 'diverged', but the accepted result has the status 'ok'"));
  const CaseResult better = hold_case("name", fails, slam_outcome(OutcomeStatus::ok, 0.9, true));
  EXPECT_TRUE(better.better);
  EXPECT_THAT(better.fault, HasSubstr("better"));
  const CaseResult cured = hold_case("name", fails, slam_outcome(OutcomeStatus::ok, 1.9, false));
  EXPECT_TRUE(cured.better);
  EXPECT_THAT(cured.fault, HasSubstr("cured"));
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THAT(fault(fails, slam_outcome(OutcomeStatus::ok, infinite, true)),
              HasSubstr("has no value, but the accepted result has a value"));
}

TEST(HoldCase, AnAcceptedResultIsCompared) {
  for (const bool map_failed : {false, true}) {
    const Outcome now = slam_outcome(OutcomeStatus::ok, 0.3, map_failed);
    for (const bool before : {false, true}) {
      const Expectation taken = accepted(expects(before, 7.0), now);
      EXPECT_EQ(taken.fails, map_failed);
      EXPECT_EQ(taken.value, 0.3);
      EXPECT_THAT(fault(taken, now), IsEmpty());
    }
  }
}

TEST(HoldCase, AShrunkDrawBecomesACaseThatStillFails) {
  Shrunk shrunk;
  shrunk.scenario.name = "cliff";
  shrunk.failure = "map_failed";
  shrunk.drawn = slam_outcome(OutcomeStatus::ok, 2.5, true);
  shrunk.drawn.seed = 77;
  shrunk.left = slam_outcome(OutcomeStatus::ok, 1.5, true);
  shrunk.lines = {{"duration_s", Fate::smaller, 9.0, 4.0},
                  {"world: rocks", Fate::removed, 30.0, {}},
                  {"world: bumps", Fate::needed, {}, {}},
                  {"motion: sway", Fate::not_tried, {}, {}}};
  const Scenario named = named_case_of(shrunk, "lost", "slam/tumble", {}, "0.1.0", "tumble shrink cliff");
  EXPECT_EQ(named.name, "lost");
  ASSERT_TRUE(named.named_case.has_value());
  EXPECT_EQ(named.named_case->scenario, "cliff");
  EXPECT_EQ(named.named_case->seed, 77u);
  EXPECT_THAT(named.doc,
              HasSubstr("fails (map_failed) on a simplified form of the simulated run with seed 77 of scenario cliff. "
                        "The failure disappears if one of these parts is removed: world: bumps. The removal of other "
                        "parts of the scenario was not tested (number of parts: 1)."));
  const Expectation& expected = named.named_case->expected.front();
  EXPECT_EQ(expected.drawn, 2.5);
  EXPECT_EQ(expected.value, 1.5);
  EXPECT_THAT(fault(expected, shrunk.left), IsEmpty());
  EXPECT_THAT(fault(expected, slam_outcome(OutcomeStatus::ok, 1.5, false)), HasSubstr("cured"));
}

TEST(HoldCase, UnknownMethodsMetricsAndStatusesAreRefused) {
  Scenario scenario;
  scenario.file = "a.yaml";
  EXPECT_THROW(require_known(scenario), BadInput);
  scenario.named_case = NamedCase{"cliff", 1, "0.1.0", "tumble shrink", {expects(true, 1.0)}};
  EXPECT_NO_THROW(require_known(scenario));
  const auto refuses = [&](auto change) {
    Scenario wrong = scenario;
    change(wrong.named_case->expected.front());
    EXPECT_THROW(require_known(wrong), BadInput);
  };
  refuses([](Expectation& e) { e.method = "slam/tumbel"; });
  refuses([](Expectation& e) { e.method = "tumble"; });
  refuses([](Expectation& e) { e.metric = "rate_error_free_median_rad_s"; });
  refuses([](Expectation& e) { e.status = "okay"; });
}

// The test checks the files of the named cases in the repository; tools/tumble/gate_cases.cpp runs them.
TEST(NamedCases, AreCompleteAndExpectWhatThereIs) {
  const DataRoot data{test::source_dir()};
  const std::vector<std::string> scenarios = scenario_names(data), names = case_names(data);
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names) {
    EXPECT_FALSE(std::binary_search(scenarios.begin(), scenarios.end(), name)) << name << " is a scenario's name too";
    const Scenario scenario = load_scenario(data, name);
    EXPECT_NO_THROW(require_known(scenario)) << name;
    const Scenario drawn = load_scenario(data, scenario.named_case->scenario);
    const sim::ResolvedSituation situation = draw(data, scenario, scenario.named_case->seed);
    // the file contains every number of the draw, so changes of data sheets and defaults do not change the case
    EXPECT_EQ(to_yaml(fixed_as(scenario, situation)), to_yaml(scenario)) << name;
    EXPECT_LE(complications(scenario).size(),
              complications(fixed_as(drawn, draw(data, drawn, scenario.named_case->seed))).size())
        << name << " is no simpler than its draw";
  }
}

}  // namespace
}  // namespace tumble::scenarios
