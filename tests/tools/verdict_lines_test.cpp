// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verdict_lines.hpp"

#include <gtest/gtest.h>

namespace tumble::tools {
namespace {

using scenarios::HealthFinding;

TEST(VerdictLines, AnEstimateWithoutTroubleSaysNothing) {
  scenarios::Estimate estimate;
  estimate.health = {{"imu_force_share", 1.0}, {"samples_slip", 12.0}, {"imu_2_time_offset_s", 0.003}};
  report_no_findings(HealthFinding::About::place, estimate);
  report_no_findings(HealthFinding::About::rate_unit, estimate);
  EXPECT_TRUE(verdict_lines(estimate).empty());
  EXPECT_EQ(estimate.health.at("localised"), 1.0);
  EXPECT_EQ(estimate.health.at("rate_unit_suspect"), 0.0);
}

TEST(VerdictLines, EachDoubtIsALineWithItsRowAndValue) {
  scenarios::Estimate estimate;
  add_finding({HealthFinding::About::readings}, estimate);
  add_finding({HealthFinding::About::unit_frozen, 4.348, "imu_2_gyro_z"}, estimate);
  add_finding({HealthFinding::About::place, 0.0}, estimate);
  add_finding({HealthFinding::About::unit_silent, 0.0, "imu_3"}, estimate);
  estimate.health["samples_slip"] = 12.0;
  const std::vector<std::string> lines = verdict_lines(estimate);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0],
            "imu_2_gyro_z_frozen_since_s 4.348: the readings are constant from this time on; check the sensor");
  EXPECT_EQ(lines[1],
            "imu_3_silent_since_s 0: the IMU delivers no readings from this time on, for at least half a second");
  EXPECT_TRUE(lines[2].starts_with("imu_implausible 1: ")) << lines[2];
  EXPECT_TRUE(lines[3].starts_with("localised 0: ")) << lines[3];
}

// For any name of the row, except for rates, which `readings` covers.
TEST(VerdictLines, EachDoubtIsSaidAlsoOfAnEstimateOfWhichOnlyTheHealthWasKept) {
  for (const HealthFinding::About about : scenarios::kAllFindings) {
    const bool of_unit = about >= HealthFinding::About::unit_frozen;
    scenarios::Estimate estimate;
    add_finding({about, about == HealthFinding::About::place ? 0.0 : 2.5, of_unit ? "imu_2" : ""}, estimate);
    const std::size_t lines = about == HealthFinding::About::rates ? 0 : 1;
    EXPECT_EQ(verdict_lines(estimate).size(), lines) << row_of(estimate.findings.at(0));
    scenarios::Estimate back;
    back.findings = scenarios::findings_in(estimate.health);
    EXPECT_EQ(back.findings, estimate.findings) << row_of(estimate.findings.at(0));
    EXPECT_EQ(verdict_lines(back), verdict_lines(estimate));
  }
}

}  // namespace
}  // namespace tumble::tools
