// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/methods/registry.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

std::size_t applicable_of(Kind kind, const std::string& scenario) {
  std::vector<MethodPointer> all;
  for (const Method& method : methods()) all.push_back(unowned(method));
  const std::vector<MethodPointer> chosen = applicable(all, subject_of(load_scenario(test::tree_data(), scenario)));
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [&](const auto& method) { return method->info.kind == kind; }));
}

std::string complaint(const std::string& method, const std::string& scenario) {
  return test::complaint(
      [&] { require_applies(*find_methods(method).front(), load_scenario(test::tree_data(), scenario)); });
}

// the wand and the pendulum of the catalogue have no lidar
TEST(Applicable, NoMapIsAskedForWhereThereIsNoLidar) {
  for (const char* scenario : {"twirl", "swing"}) {
    EXPECT_EQ(applicable_of(Kind::slam, scenario), 0u) << scenario;
    EXPECT_GE(applicable_of(Kind::rate, scenario), 5u) << scenario;
    EXPECT_GE(applicable_of(Kind::attitude, scenario), 3u) << scenario;
  }
  EXPECT_GE(applicable_of(Kind::slam, "hill"), 5u);
}

TEST(Applicable, WhatDoesNotApplySaysWhy) {
  EXPECT_THAT(complaint("slam/tumble", "twirl"), HasSubstr("needs a lidar, but the recording has none"));
  EXPECT_THAT(complaint("position/rolling", "hill"), HasSubstr("does not support the robot 'rig'"));
  EXPECT_EQ(complaint("slam/tumble", "hill"), "");
  EXPECT_EQ(complaint("rate/tumble", "twirl"), "");
}

// a recording that names no robot may belong to any robot
TEST(Applicable, AnUnknownRobotExcludesNothing) {
  EXPECT_TRUE(find_methods("position/rolling").front()->info.applies_to({"", true}));
  EXPECT_FALSE(find_methods("position/rolling").front()->info.applies_to({"rig", true}));
  EXPECT_FALSE(find_methods("slam/tumble").front()->info.applies_to({"", false}));
}

std::string status_of(const MethodInfo& info, const Estimate& estimate) {
  Outcome outcome;
  judge_without_truth(info, estimate, outcome);
  return to_string(outcome.status) + std::string(outcome.message.empty() ? "" : ": " + outcome.message);
}

// every verb that runs a method reports this status
TEST(JudgeWithoutTruth, AFaultThatInvalidatesOurEstimateIsADivergence) {
  MethodInfo ours, baseline;
  ours.ours = true;
  const auto finding = [](HealthFinding::Kind kind) {
    HealthFinding out;
    out.kind = kind;
    out.sensor = "imu";
    return out;
  };
  Estimate estimate;
  EXPECT_EQ(status_of(ours, estimate), "ok");
  add_finding(finding(HealthFinding::Kind::frozen_axis), estimate);
  EXPECT_EQ(status_of(ours, estimate), "ok") << "one axis does not invalidate the estimate";
  add_finding(finding(HealthFinding::Kind::wrong_force_magnitude_at_rest), estimate);
  EXPECT_THAT(status_of(ours, estimate), AllOf(HasSubstr("diverged: health: imu: "), HasSubstr("wrong unit or scale")));
  EXPECT_EQ(status_of(baseline, estimate), "ok") << "baselines do not report their health";
  estimate.status = {ErrorCode::insufficient_data, "lidar.sweeps_registered", 0.0, 1.0};
  EXPECT_THAT(status_of(ours, estimate), HasSubstr("failed: insufficient_data"));
}

}  // namespace
}  // namespace tumble::scenarios
