// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verdict_lines.hpp"

#include <gtest/gtest.h>

namespace tumble::tools {
namespace {

TEST(VerdictLines, AnEstimateWithoutTroubleSaysNothing) {
  scenarios::Estimate estimate;
  estimate.health = {{"imu_force_share", 1.0},  {"localised", 1.0},       {"rate_unit_suspect", 0.0},
                     {"samples_slip", 12.0},    {"imu_implausible", 0.0}, {"imu_2_time_offset_s", 0.003},
                     {"started_in_motion", 1.0}};
  EXPECT_TRUE(verdict_lines(estimate).empty());
}

TEST(VerdictLines, EachVerdictIsALineWithItsRowAndValue) {
  scenarios::Estimate estimate;
  estimate.health = {{"imu_implausible", 1.0},
                     {"imu_2_gyro_z_frozen_since_s", 4.348},
                     {"imu_3_silent_since_s", 0.0},
                     {"localised", 0.0},
                     {"samples_slip", 12.0}};
  const std::vector<std::string> lines = verdict_lines(estimate);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "imu_2_gyro_z_frozen_since_s 4.348: repeats one reading from then on");
  EXPECT_EQ(lines[1], "imu_3_silent_since_s 0: without readings from then on, for half a second at least");
  EXPECT_TRUE(lines[2].starts_with("imu_implausible 1: ")) << lines[2];
  EXPECT_TRUE(lines[3].starts_with("localised 0: ")) << lines[3];
}

}  // namespace
}  // namespace tumble::tools
