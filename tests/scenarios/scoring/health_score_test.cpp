// SPDX-License-Identifier: BSD-3-Clause
// Tests of the health as a classifier of wrong estimates, and of the status of a run whose health invalidates the
// estimate.
#include "scenarios/estimates/findings.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/perfect_estimate.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using testing::perfect_estimate;
using testing::scores;

HealthFinding finding(HealthFinding::Kind kind) {
  return {kind, "imu", "", "quantity", 2.0, 1.0};
}

/// Returns rates that are too large by the fraction `share`.
Estimate fast_rates(double share) {
  Estimate estimate = perfect_estimate(rig());
  for (AngularRateState& rate : estimate.rates) rate.w_WI_I_rad_s *= 1.0 + share;
  return estimate;
}

TEST(HealthScores, AWrongRateIsWrongWhateverItsHealthAddsToTheCovariance) {
  EXPECT_EQ(scores(Kind::rate, fast_rates(0.0), rig()).at("health_wrong"), 0.0);
  EXPECT_LT(scores(Kind::rate, fast_rates(0.0), rig()).at("health_unreported_error"), 1.0);
  Estimate wrong = fast_rates(0.1);  // the standard deviation is 1 mrad/s
  EXPECT_EQ(scores(Kind::rate, wrong, rig()).at("health_wrong"), 1.0);
  EXPECT_GT(scores(Kind::rate, wrong, rig()).at("health_unreported_error"), 10.0);
  wrong.suspect_rad2_s2.assign(wrong.rates.size(), 100.0 * Eigen::Matrix3d::Identity());
  for (AngularRateState& rate : wrong.rates) rate.covariance_rad2_s2 += 100.0 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(scores(Kind::rate, wrong, rig()).at("health_wrong"), 1.0);
  Estimate gross = fast_rates(0.3);  // the estimate is wrong for any covariance
  for (AngularRateState& rate : gross.rates) rate.covariance_rad2_s2 = 100.0 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(scores(Kind::rate, gross, rig()).at("health_wrong"), 1.0);
  EXPECT_NEAR(scores(Kind::rate, gross, rig()).at("health_unreported_error"), 1.5, 1e-9);
}

TEST(HealthScores, AFindingReportsAWrongEstimateUnlessItConcernsAnUnusedImu) {
  Estimate wrong = fast_rates(0.1);
  add_finding(finding(HealthFinding::Kind::imu_silent), wrong);
  EXPECT_EQ(scores(Kind::rate, wrong, rig()).at("health_reported"), 0.0);
  add_finding(finding(HealthFinding::Kind::inconsistent_rotation), wrong);
  const auto values = scores(Kind::rate, wrong, rig());
  EXPECT_EQ(values.at("health_reported"), 1.0);
  EXPECT_EQ(values.at("health_unreported_error"), 0.0);
}

TEST(HealthScores, ARunOfOursThatReportsItselfDivergedAndKeepsItsScores) {
  SimulatedDraw draw;
  draw.recording = rig();
  Estimate estimate = perfect_estimate(rig());
  const auto assessed = [&](const char* method) {
    Outcome outcome;
    outcome.status = OutcomeStatus::ok;
    assess(*find_methods(method).front(), draw, nullptr, estimate, outcome);
    return outcome;
  };
  EXPECT_EQ(assessed("rate/tumble").status, OutcomeStatus::ok);
  add_finding(finding(HealthFinding::Kind::frozen_axis), estimate);
  EXPECT_EQ(assessed("rate/tumble").status, OutcomeStatus::ok) << "its covariance includes the fault";
  add_finding(finding(HealthFinding::Kind::inconsistent_rotation), estimate);
  const Outcome diverged = assessed("rate/tumble");
  EXPECT_EQ(diverged.status, OutcomeStatus::diverged);
  EXPECT_TRUE(diverged.message.starts_with("health: imu: the gyro contradicts")) << diverged.message;
  EXPECT_EQ(value_of(diverged.scores, "health_reported"), 1.0);
  EXPECT_EQ(assessed("rate/raw").status, OutcomeStatus::ok) << "the rule is for our methods";
}

}  // namespace
}  // namespace tumble::scenarios
