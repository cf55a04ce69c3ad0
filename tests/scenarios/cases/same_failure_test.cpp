// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/same_failure.hpp"

#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

Outcome outcome(OutcomeStatus status, std::vector<Score> scores = {}) {
  Outcome out;
  out.status = status;
  out.scores = std::move(scores);
  return out;
}

TEST(SameFailure, AStatusIsMatchedByTheSameAlone) {
  const SameFailure diverged({}, outcome(OutcomeStatus::diverged));
  EXPECT_TRUE(diverged.holds(outcome(OutcomeStatus::diverged)));
  EXPECT_FALSE(diverged.holds(outcome(OutcomeStatus::failed)));
  EXPECT_FALSE(diverged.holds(outcome(OutcomeStatus::rejected)));
  EXPECT_FALSE(diverged.holds(outcome(OutcomeStatus::ok, {{"map_failed", 1.0}})));
  EXPECT_EQ(diverged.describe(), "diverged");
}

TEST(SameFailure, TheMetricAskedForStandsBeforeAVerdict) {
  const Outcome both = outcome(OutcomeStatus::ok, {{"map_failed", 1.0}, {"translation_error_end_m", 2.0}});
  const SameFailure by_metric({"translation_error_end_m", 1.0}, both);
  EXPECT_TRUE(by_metric.holds(outcome(OutcomeStatus::ok, {{"translation_error_end_m", 1.1}})));
  EXPECT_FALSE(by_metric.holds(outcome(OutcomeStatus::ok, {{"translation_error_end_m", 0.9}, {"map_failed", 1.0}})));
  EXPECT_EQ(by_metric.describe(), "translation_error_end_m > 1");
  const SameFailure by_verdict({}, both);
  EXPECT_EQ(by_verdict.describe(), "map_failed");
  EXPECT_TRUE(by_verdict.holds(outcome(OutcomeStatus::ok, {{"map_failed", 1.0}})));
  EXPECT_FALSE(by_verdict.holds(outcome(OutcomeStatus::ok, {{"map_failed", 0.0}})));
  const SameFailure overlap({"map_overlap", 0.8}, outcome(OutcomeStatus::ok, {{"map_overlap", 0.5}}));
  EXPECT_TRUE(overlap.holds(outcome(OutcomeStatus::ok, {{"map_overlap", 0.7}})));
  EXPECT_FALSE(overlap.holds(outcome(OutcomeStatus::ok, {{"map_overlap", 0.9}})));
}

TEST(SameFailure, ARunWithoutTheMetricIsAnotherThing) {
  const SameFailure failure({"ate_m", 1.0}, outcome(OutcomeStatus::ok, {{"ate_m", 2.0}}));
  EXPECT_FALSE(failure.holds(outcome(OutcomeStatus::ok)));
  EXPECT_FALSE(failure.holds(outcome(OutcomeStatus::ok, {{"ate_m", std::nan("")}})));
}

TEST(SameFailure, WhatDoesNotFailIsRefused) {
  const auto complaint = [](const FailureGoal& failure, const Outcome& of) {
    return test::complaint([&] { const SameFailure same(failure, of); });
  };
  EXPECT_THAT(complaint({"ate_m", 1.0}, outcome(OutcomeStatus::ok, {{"ate_m", 0.5}})),
              HasSubstr("ate_m is 0.5, which is not worse than the limit 1"));
  EXPECT_THAT(complaint({"ate_m", 1.0}, outcome(OutcomeStatus::ok)), HasSubstr("ate_m is missing"));
  EXPECT_THAT(complaint({}, outcome(OutcomeStatus::ok, {{"map_failed", 0.0}})), HasSubstr("does not fail"));
  EXPECT_THAT(complaint({}, outcome(OutcomeStatus::killed)), HasSubstr("the operating system"));
}

}  // namespace
}  // namespace tumble::scenarios
