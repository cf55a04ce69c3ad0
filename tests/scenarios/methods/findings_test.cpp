// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/findings.hpp"

#include <gtest/gtest.h>

#include <set>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {
namespace {

// Names that are stored in files and databases.
TEST(Doubts, RowsAreNamedAsInFiles) {
  std::set<std::string> rows;
  for (const HealthFinding::About about : kAllFindings) rows.insert(row_of({about, 1.0, ""}));
  EXPECT_EQ(rows, (std::set<std::string>{
                      "imu_implausible", "imu_rates_doubted", "imu_flight_against_s", "imu_stamps_rounded_s",
                      "rate_unit_suspect", "force_unit_suspect", "attitude_unknown_s", "localised",
                      "lidar_scale_implausible", "imu_readings_beyond_range", "recording_without_digest",
                      "learnt_rig_contradicted", "_frozen_since_s", "_disagrees_since_s", "_silent_since_s"}));
}

TEST(Doubts, StayInOrderOnceEachAndAreRowsOfTheHealth) {
  Estimate estimate;
  add_finding({HealthFinding::About::place, 0.0}, estimate);
  add_finding({HealthFinding::About::readings}, estimate);
  add_finding({HealthFinding::About::unit_frozen, 1.0, "imu_gyro_z"}, estimate);
  add_finding({HealthFinding::About::unit_frozen, 2.0, "imu_gyro_z"}, estimate);
  add_finding({HealthFinding::About::readings}, estimate);
  const std::vector<HealthFinding> expected = {{HealthFinding::About::unit_frozen, 2.0, "imu_gyro_z"},
                                               {HealthFinding::About::readings},
                                               {HealthFinding::About::place, 0.0}};
  EXPECT_EQ(estimate.findings, expected);
  EXPECT_EQ(estimate.health, (std::map<std::string, double>{
                                 {"imu_gyro_z_frozen_since_s", 2.0}, {"imu_implausible", 1.0}, {"localised", 0.0}}));
  EXPECT_TRUE(has_finding({HealthFinding::About::unit_frozen, 0.0, "imu_gyro_z"}, estimate));
  EXPECT_FALSE(has_finding({HealthFinding::About::unit_frozen, 0.0, "imu_gyro_y"}, estimate));
}

TEST(Doubts, ReadBackAreThoseThatTheHealthSays) {
  const std::map<std::string, double> sound = {{"imu_force_share", 1.0},   {"localised", 1.0},
                                               {"rate_unit_suspect", 0.0}, {"samples_slip", 12.0},
                                               {"imu_implausible", 0.0},   {"imu_2_time_offset_s", 0.003}};
  EXPECT_TRUE(findings_in(sound).empty());
  EXPECT_EQ(findings_in({{"localised", 0.0}, {"imu_2_silent_since_s", 0.0}}),
            (std::vector<HealthFinding>{{HealthFinding::About::unit_silent, 0.0, "imu_2"},
                                        {HealthFinding::About::place, 0.0}}));
}

}  // namespace
}  // namespace tumble::scenarios
