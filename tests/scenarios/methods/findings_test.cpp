// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/findings.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/estimates/method.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using About = HealthFinding::Kind;

HealthFinding finding(About kind, const char* sensor = "", const char* axis = "") {
  return {kind, sensor, axis, "time in s", 4.0, 1.0, TimeNs{2'000'000'000}};
}

Estimate estimate_with(const HealthFinding& finding) {
  Estimate out;
  add_finding(finding, out);
  return out;
}

TEST(Findings, HaveEntriesInTheHealth) {
  using Rows = std::map<std::string, double>;
  EXPECT_EQ(estimate_with(finding(About::frozen_axis, "imu", "gyro_z")).health, (Rows{{"imu_implausible", 1.0}}));
  EXPECT_EQ(estimate_with(finding(About::imu_frozen, "imu_2", "gyro_z")).health, Rows{});
  EXPECT_FALSE(has_consistent_poses(estimate_with(finding(About::tracking_lost))));
  EXPECT_TRUE(has_consistent_poses({}));
  Estimate lost = estimate_with(finding(About::not_localised)), found;
  report_localised(lost), report_localised(found);
  EXPECT_EQ(lost.health, (Rows{{"localised", 0.0}}));
  EXPECT_EQ(found.health, (Rows{{"localised", 1.0}}));
}

TEST(Findings, AreAddedOnceWithTheNamesOfTheRecording) {
  SensorHealth health;
  health.add(finding(About::imu_frozen, "imu_1"));
  health.add(finding(About::imu_frozen, "imu_2"));
  health.add(finding(About::imu_frozen, "imu_2"));
  Estimate estimate;
  add_findings(health, std::vector<std::string>{"left", "right"}, estimate);
  add_findings(health, std::vector<std::string>{"left", "right"}, estimate);
  ASSERT_EQ(estimate.faults.findings.size(), 2u);
  EXPECT_TRUE(has_finding(About::imu_frozen, estimate, "left"));
  EXPECT_TRUE(has_finding(About::imu_frozen, estimate, "right"));
  EXPECT_FALSE(has_finding(About::imu_frozen, estimate, "imu_2"));
  EXPECT_FALSE(has_finding(About::imu_silent, estimate));
  EXPECT_FALSE(estimate.faults.invalidates_estimate()) << "the other IMUs are used";
}

TEST(Findings, OfEveryKindAreReadBackFromTheirFile) {
  std::set<std::string> names;
  for (int k = 0; k <= static_cast<int>(HealthFinding::kLast); ++k) {
    const HealthFinding written = finding(static_cast<About>(k), "imu_2", k % 2 == 0 ? "accel_x" : "");
    const HealthFinding read = finding_in("estimate.json", json_of(written));
    EXPECT_EQ(to_text(read), to_text(written));
    EXPECT_EQ(read.kind, written.kind);
    EXPECT_EQ(read.since_ns, written.since_ns);
    EXPECT_EQ(read.ended, written.ended);
    names.insert(to_string(written.kind));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(HealthFinding::kLast) + 1);
  nlohmann::json unknown = json_of(finding(About::frozen_axis));
  unknown["kind"] = "tired";
  EXPECT_THROW(finding_in("estimate.json", unknown), BadInput);
}

TEST(SensorHealthOfALiveRun, AFindingThatEndsNoLongerInvalidatesTheEstimateUnlessPosesWereLost) {
  HealthFinding lost = finding(About::tracking_lost), vertical = finding(About::vertical_unknown),
                mounting = finding(About::lidar_calibration);
  for (HealthFinding* each : {&lost, &vertical, &mounting}) {
    EXPECT_TRUE(each->invalidates_estimate());
    each->ended = true;
  }
  EXPECT_TRUE(lost.invalidates_estimate());
  EXPECT_FALSE(vertical.invalidates_estimate());
  EXPECT_FALSE(mounting.invalidates_estimate()) << "the estimated mounting agrees with the stated mounting again";
}

TEST(Findings, AnEndedFindingIsReportedAsEarlier) {
  HealthFinding lost = finding(About::tracking_lost), start = finding(About::not_localised);
  EXPECT_EQ(report_text(start), to_text(start));
  lost.ended = start.ended = true;
  EXPECT_FALSE(is_current(start));
  EXPECT_EQ(report_text(start), "earlier in the run: " + to_text(start));
  EXPECT_TRUE(is_current(lost)) << "all later poses are wrong";
  EXPECT_EQ(report_text(lost), to_text(lost));
}

TEST(SensorHealthOfALiveRun, AGyroScaleThatGravityConfirmsLaterIsNoFault) {
  SensorHealth run, now;
  now.add(finding(About::gyro_scale));
  now.add(finding(About::inconsistent_rotation));
  run.add_current_and_end_others(now);
  EXPECT_TRUE(run.findings[0].invalidates_estimate());
  run.add_current_and_end_others({});
  EXPECT_FALSE(run.findings[0].invalidates_estimate());
  EXPECT_TRUE(run.findings[1].invalidates_estimate()) << "control: a contradiction that ended still counts";
  Estimate estimate;
  add_findings(run, {}, estimate);
  EXPECT_TRUE(has_implausible_readings(estimate));
  estimate.faults.findings.pop_back();
  EXPECT_FALSE(has_implausible_readings(estimate));
}

}  // namespace
}  // namespace tumble::scenarios
